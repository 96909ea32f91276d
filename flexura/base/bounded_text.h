#pragma once

#include <string>

namespace flexura {

/// Returns a computed number as text with `digits` significant digits: "0.12". For values above `most` (for
/// example from a failed fit) and values that are not finite, returns "more than MOST".
[[nodiscard]] std::string bounded_text(double value, double most, int digits = 2);

}  // namespace flexura
