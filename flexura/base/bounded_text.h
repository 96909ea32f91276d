#pragma once

#include <string>

namespace flexura {

/// Returns a computed number for a message, with `digits` significant digits: "0.12". For a value above
/// `most`, such as the result of a failed fit, and for a value that is not finite, returns "more than MOST".
[[nodiscard]] std::string bounded_text(double value, double most, int digits = 2);

}  // namespace flexura
