#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "flexura/base/image.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// The share of a pixel that lies within `distance` (a signed distance of its middle, px, positive outside).
inline double share(double distance) { return std::clamp(0.5 - distance, 0.0, 1.0); }

/// A dark arm before a bright ground whose middle is at v = middle(u), `thickness` px across.
template <typename Middle>
Image<std::uint8_t> gray_arm(const Middle& middle, double thickness, TestRandom& random) {
  Image<std::uint8_t> picture(320, 240);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const double slope = (middle(u + 0.5) - middle(u - 0.5));
      const double off = std::abs(v - middle(u)) / std::hypot(1.0, slope) - 0.5 * thickness;
      const double dark = u > 20 && u < 300 ? share(off) : 0;
      picture.at(u, v) = static_cast<std::uint8_t>(std::lround(220 - 190 * dark + random.uniform(-3, 3)));
    }
  }
  return picture;
}

}  // namespace flexura
