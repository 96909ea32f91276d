#pragma once

#include <cstdint>
#include <string>

#include "flexura/base/image.h"

namespace flexura {

/// How much larger one picture shows a figure than another.
struct ZoomCorrelation {
  std::string reason;  ///< Why that is not known; "" when it is.
  double ratio = 1;    ///< The real one's size over the ideal one's.
  double peak = 0;     ///< The normalised cross-correlation there, 1 at most.
};

/// The ratio between 1/2 and 2 at which the ideal picture, enlarged by it about its figure's centroid and
/// laid upon that of the real one, has the largest normalised cross-correlation with the real one (step 13 of
/// section 3.4). Both are gray, and of the same size: std::invalid_argument otherwise.
[[nodiscard]] ZoomCorrelation correlate_zoom(const Image<std::uint8_t>& real,
                                             const Image<std::uint8_t>& ideal);

}  // namespace flexura
