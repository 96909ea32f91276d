#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "flexura/base/source.h"

namespace flexura {

/// Maximum number of problems that are reported for one input. With more problems, the first problems would
/// scroll off a terminal.
inline constexpr std::size_t max_listed_problems = 20;

/// Returns, as one line of text, the first max_listed_problems problems of a line of input and the number of
/// further problems. Omits the input line's number, which the caller knows.
[[nodiscard]] std::string joined(const std::vector<Problem>& problems);

}  // namespace flexura
