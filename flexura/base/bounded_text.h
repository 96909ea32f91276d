#pragma once

#include <string>

namespace flexura {

/// Returns a computed number for a message, in so many digits: "0.12". A number above `most` is no
/// measurement any more, as that of a fit that failed: then "more than MOST". Numbers that are not finite
/// count as above.
[[nodiscard]] std::string bounded_text(double value, double most, int digits = 2);

}  // namespace flexura
