#pragma once

#include <cstdint>
#include <string>

#include "flexura/base/image.h"

namespace flexura {

/// Size of a figure in one picture relative to another.
struct ZoomCorrelation {
  std::string reason;  ///< Why the ratio is not known, or "".
  double ratio = 1;    ///< Size in the real picture divided by the size in the ideal picture.
  double peak = 0;     ///< Normalised cross-correlation at this ratio, at most 1.
};

/// Finds the ratio between 1/2 and 2 with the largest normalised cross-correlation (step 13 of section 3.4 of
/// the paper). The ideal picture is enlarged by this ratio about the centroid of its figure, and shifted so
/// that the centroids of both figures coincide. Throws std::invalid_argument unless both pictures are gray
/// and have equal size.
[[nodiscard]] ZoomCorrelation correlate_zoom(const Image<std::uint8_t>& real,
                                             const Image<std::uint8_t>& ideal);

}  // namespace flexura
