#pragma once

#include "flexura/base/image.h"

namespace flexura {

/// Light on the image plane of an ideal camera. The value of a pixel is the mean light over the pixel's
/// square.
struct LightImage {
  /// Linear light with one channel (gray) or three channels (red, green, blue); 1 is full scale.
  Image<float> light;
  Image<float>
      depth;  ///< Depth along the optical axis in the middle of each pixel, m; infinite without a surface.
};

}  // namespace flexura
