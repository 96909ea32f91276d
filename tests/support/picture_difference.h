#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>

#include "flexura/camera/view.h"
#include "flexura/render/picture.h"
#include "flexura/render/prepared_scene.h"
#include "flexura/render/quick_picture.h"
#include "flexura/render/renderer.h"
#include "flexura/render/scene.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// How two pictures of one scene differ.
struct Difference {
  double worst = 0;         // Of light.
  int count = 0, many = 0;  // Of values of light that differ by more than 1/500, of all.
  double depth = 0;         // Relative; infinite where one of them shows nothing.
  int bad_depths = 0;       // Of those that differ by more than 2e-6 of it.

  // What is not a number is infinitely off.
  static void raise(double& largest, double off) {
    if (!(off <= largest)) largest = std::isnan(off) ? std::numeric_limits<double>::infinity() : off;
  }
  void add(const Difference& other) {
    raise(worst, other.worst), raise(depth, other.depth);
    count += other.count, many += other.many, bad_depths += other.bad_depths;
  }
};

inline Difference compare(const LightImage& exact, const LightImage& quick) {
  Difference result;
  for (std::size_t i = 0; i < exact.light.values().size(); ++i) {
    const double off = std::abs(exact.light.values()[i] - quick.light.values()[i]);
    Difference::raise(result.worst, off);
    if (!(off <= 0.002)) ++result.count;
    ++result.many;
  }
  for (std::size_t i = 0; i < exact.depth.values().size(); ++i) {
    const auto a = static_cast<double>(exact.depth.values()[i]),
               b = static_cast<double>(quick.depth.values()[i]);
    if (a == b) continue;
    const double off = std::isinf(a) ? a : std::abs(a - b) / a;
    Difference::raise(result.depth, off);
    if (!(off <= 2e-6)) ++result.bad_depths;
  }
  return result;
}

/// How a scene drawn the quick way differs from the same drawn exactly.
inline Difference compare_paths(const Scene& scene, const View& view, PixelKind pixels = PixelKind::gray) {
  Renderer renderer;
  LightImage exact, quick;
  renderer.render(scene, view, pixels, exact, true);
  renderer.render(scene, view, pixels, quick);
  return compare(exact, quick);
}

/// A scene and who sees it.
struct SceneView {
  Scene scene;
  View view;
  PixelKind pixels = PixelKind::gray;
};

/// How the two ways differ in `count` sights, as draw(random) makes them: in light by less than `most`, in
/// depth by less than `deepest` of it.
template <typename Draw>
Difference compare_paths_of(const char* name, int count, double most, Draw&& draw, double deepest = 1e-5) {
  Difference all;
  for_random_cases(count, [&](TestRandom& random) {
    const SceneView scene_view = draw(random);
    const Difference off = compare_paths(scene_view.scene, scene_view.view, scene_view.pixels);
    EXPECT_LT(off.worst, most);
    EXPECT_LT(off.depth, deepest);
    all.add(off);
  });
  std::printf("%s: light differs by %.5f at worst, depth by %.2g of it\n", name, all.worst, all.depth);
  return all;
}

inline void expect_same_on_every_path(const SceneView& scene_view) {
  LightImage expected, picture;
  Renderer(SimdPath::baseline).render(scene_view.scene, scene_view.view, scene_view.pixels, expected);
  for (const SimdPath path : available_simd_paths()) {
    Renderer(path).render(scene_view.scene, scene_view.view, scene_view.pixels, picture);
    EXPECT_EQ(picture.light, expected.light) << name_of(path);
    EXPECT_EQ(picture.depth, expected.depth) << name_of(path);
  }
}

/// How many pixels of a gray picture the quick way leaves to the exact one; all if it draws nothing.
inline std::size_t left_out_of(const Scene& scene, const View& view) {
  Renderer renderer;
  renderer.prepare(scene, view);
  LightImage picture{Image<float>(view.width, view.height), Image<float>(view.width, view.height)};
  QuickPicture quick;
  const PreparedScene& prepared = renderer.prepared();
  const bool is_drawn =
      quick.draw(prepared.stage, prepared.rays, view.lens.intrinsics(), PixelKind::gray, picture);
  return is_drawn ? quick.left_out().size() : picture.depth.values().size();
}

}  // namespace flexura
