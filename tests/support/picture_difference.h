#pragma once

#include <cmath>
#include <cstddef>
#include <limits>

#include "flexura/camera/view.h"
#include "flexura/render/picture.h"
#include "flexura/render/renderer.h"
#include "flexura/render/scene.h"

namespace flexura {

/// How two pictures of one scene differ.
struct Difference {
  double worst = 0;         // Of light.
  int count = 0, many = 0;  // Of values of light that differ by more than 1/500, of all.
  int bad_depths = 0;       // Of those that differ by more than 2e-6 of it.
};

inline Difference compare(const LightImage& exact, const LightImage& quick) {
  Difference result;
  for (std::size_t i = 0; i < exact.light.values().size(); ++i) {
    const double off = std::abs(exact.light.values()[i] - quick.light.values()[i]);
    // Written so that what is not a number differs.
    if (!(off <= result.worst))
      result.worst = std::isnan(off) ? std::numeric_limits<double>::infinity() : off;
    if (!(off <= 0.002)) ++result.count;
    ++result.many;
  }
  for (std::size_t i = 0; i < exact.depth.values().size(); ++i) {
    const double a = static_cast<double>(exact.depth.values()[i]),
                 b = static_cast<double>(quick.depth.values()[i]);
    if (a != b && !(std::abs(a - b) <= 2e-6 * a)) ++result.bad_depths;
  }
  return result;
}

/// How a scene drawn the quick way differs from the same drawn exactly.
inline Difference compare_ways(const Scene& scene, const View& view, PixelKind pixels = PixelKind::gray) {
  Renderer renderer;
  LightImage exact, quick;
  renderer.render(scene, view, pixels, exact, true);
  renderer.render(scene, view, pixels, quick);
  return compare(exact, quick);
}

}  // namespace flexura
