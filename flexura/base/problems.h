#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/base/source.h"

namespace flexura {

/// So many of the problems of one input are told, for a hundred thousand would scroll the first away.
inline constexpr std::size_t max_listed_problems = 20;

/// The first problems of one line of input (max_listed_problems) and how many more there are, in one line;
/// the place is the line itself, which the asker knows.
[[nodiscard]] std::string joined(const std::vector<Problem>& problems);

}  // namespace flexura
