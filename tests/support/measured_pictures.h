#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "flexura/app/measure.h"
#include "flexura/base/image.h"
#include "tests/support/drawn_arms.h"

namespace flexura {

/// Returns a picture of a dark bent tube 12 px wide on a bright background, with three red bands.
inline Image<std::uint8_t> tube() {
  Image<std::uint8_t> picture(320, 240, 3);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const double radius = std::hypot(u - 300.0, v - 120.0), inside = v > 20 && v < 220 && u < 300 ? 1 : 0;
      const double dark = inside * share(std::abs(radius - 150) - 6);
      const bool is_band = std::abs(v - 70) < 4 || std::abs(v - 120) < 4 || std::abs(v - 170) < 4;
      for (int c = 0; c < 3; ++c) {
        const double figure = is_band && c == 0 ? 150 : 20;
        picture.at(u, v, c) = static_cast<std::uint8_t>(std::lround(220 + dark * (figure - 220)));
      }
    }
  }
  return picture;
}

/// Returns the measurement of a picture file.
inline Measurement measured(const std::string& file, MeasureTarget what = MeasureTarget::arm) {
  MeasureConfig config;
  config.what = what;
  return measure_picture({reinterpret_cast<const std::uint8_t*>(file.data()), file.size()}, "test.png",
                         config, true);
}

}  // namespace flexura
