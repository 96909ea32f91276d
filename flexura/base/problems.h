#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/base/source.h"

namespace flexura {

/// Maximum number of reported problems of one input: a hundred thousand would scroll the first away.
inline constexpr std::size_t max_listed_problems = 20;

/// Returns the first problems of one line of input (max_listed_problems) and the number of further ones, in
/// one line. Positions are omitted: the caller knows the line.
[[nodiscard]] std::string joined(const std::vector<Problem>& problems);

}  // namespace flexura
