#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "flexura/base/image.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Returns the covered share of a pixel. `distance`: signed distance of its centre to the border, px,
/// positive outside.
inline double share(double distance) { return std::clamp(0.5 - distance, 0.0, 1.0); }

/// Draws a dark arm on a bright background, with the centerline v = middle(u) and `thickness` px wide.
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
