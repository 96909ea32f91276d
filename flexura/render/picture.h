#pragma once

#include "flexura/base/image.h"

namespace flexura {

/// What reaches the image plane of an ideal camera: each pixel's light is the mean over its square.
struct LightImage {
  Image<float> light;  ///< One channel (gray) or three (red, green, blue); linear, in the scene's units.
  Image<float>
      depth;  ///< In the middle of each pixel, along the optical axis, m; infinity: nothing is there.
};

}  // namespace flexura
