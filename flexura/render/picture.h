#pragma once

#include "flexura/base/image.h"

namespace flexura {

/// Light on the image plane of an ideal camera. Each pixel has the mean light over its square.
struct LightImage {
  Image<float> light;  ///< Linear light, one channel (gray) or three (red, green, blue); 1 is full scale.
  Image<float>
      depth;  ///< Depth along the optical axis in the middle of each pixel, m; infinite without a surface.
};

}  // namespace flexura
