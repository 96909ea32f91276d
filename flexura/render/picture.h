#pragma once

#include "flexura/base/image.h"

namespace flexura {

/// Light on the image plane of an ideal camera: each pixel holds the mean over its square.
struct LightImage {
  Image<float> light;  ///< One channel (gray) or three (red, green, blue); linear, in the scene's units.
  Image<float> depth;  ///< Depth in the middle of each pixel, along the optical axis, m; infinite where there
                       ///< is no surface.
};

}  // namespace flexura
