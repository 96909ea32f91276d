#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "flexura/render/cell.h"
#include "flexura/render/renderer.h"
#include "flexura/render/tracer.h"
#include "tests/support/frustums.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

struct Errors {
  double squares = 0, largest = 0;
  int count = 0;

  void add(double error) {
    squares += error * error;
    largest = std::max(largest, std::abs(error));
    ++count;
  }
  [[nodiscard]] double rms() const { return std::sqrt(squares / std::max(1, count)); }
};

// The share of `samples` x `samples` points of pixel (u, v) at which the tube shows an s that is_counted.
template <typename IsCounted>
double sampled(const std::vector<FrustumTube::Frustum>& frustums, const View& view, int u, int v, int samples,
               IsCounted&& is_counted) {
  const Intrinsics& lens = view.lens.intrinsics();
  int hits = 0;
  for (int j = 0; j < samples; ++j) {
    for (int i = 0; i < samples; ++i) {
      const double x = u - 0.5 + (i + 0.5) / samples, y = v - 0.5 + (j + 0.5) / samples;
      const Eigen::Vector3d direction((x - lens.cx) / lens.fx, (y - lens.cy) / lens.fy, 1);
      const auto meeting = FrustumTube::meet(frustums, view.X_WC.position, view.X_WC.rotation * direction);
      if (meeting.s >= 0 && is_counted(meeting.s)) ++hits;
    }
  }
  return static_cast<double>(hits) / (samples * samples);
}

// Adds the errors of the border pixels of `light`, which is 1 where the tube shows an s that is_counted.
template <typename IsCounted>
void compare(const Image<float>& light, const FrustumTube& tube, const View& view, IsCounted&& is_counted,
             Errors& errors) {
  const Intrinsics& lens = view.lens.intrinsics();
  for (int v = 0; v < view.height; ++v) {
    for (int u = 0; u < view.width; ++u) {
      const Eigen::Vector3d middle((u - lens.cx) / lens.fx, (v - lens.cy) / lens.fy, 1);
      const auto near = tube.near(view.X_WC.position, view.X_WC.rotation * middle, 1 / lens.fx);
      const double found = light.at(u, v);
      const double rough = sampled(near, view, u, v, 5, is_counted);
      const bool is_inner = (rough == 0 || rough == 1) && std::abs(found - rough) < 1e-6;
      if (!is_inner) errors.add(found - sampled(near, view, u, v, 64, is_counted));
    }
  }
}

// The demand, px.
void expect_small(const Errors& errors) {
  std::printf("%d border pixels: rms %.5f, largest %.5f px\n", errors.count, errors.rms(), errors.largest);
  EXPECT_GT(errors.count, 200);
  EXPECT_LT(errors.rms(), 0.01);
  EXPECT_LT(errors.largest, 0.05);
}

constexpr int frustums_a_section = 300;

void compare_silhouettes(TestRandom& random, double taper, Errors& errors) {
  const BentArm bent = random_bent_arm(random, taper);
  const Backbone backbone = bent.backbone();
  const FrustumTube tube(bent.arm, backbone, frustums_a_section);
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(bent.arm, backbone);
  scene.arm.albedo = {1, 1, 1};
  const View view = random_view_of(random, backbone);
  Renderer renderer;
  LightImage picture;
  renderer.render(scene, view, PixelKind::gray, picture);
  compare(picture.light, tube, view, [](double) { return true; }, errors);
}

TEST(Coverage, OfTubesIsThatOfManySamples) {
  Errors errors;
  for_random_cases(6, [&](TestRandom& random) { compare_silhouettes(random, 0, errors); });
  expect_small(errors);
}

TEST(Coverage, OfTaperedTubesIsThatOfManySamples) {
  Errors errors;
  for_random_cases(6, [&](TestRandom& random) { compare_silhouettes(random, 0.006, errors); });
  expect_small(errors);
}

TEST(Coverage, OfMarkerRingsIsThatOfManySamples) {
  Errors errors;
  for_random_cases(6, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0.004);
    const Backbone backbone = bent.backbone();
    const FrustumTube tube(bent.arm, backbone, frustums_a_section);
    Scene scene = plain_scene();
    scene.arm.tube = tube_of(bent.arm, backbone);
    scene.arm.albedo = Color::Zero();
    for (int i = 0; i < 9; ++i) scene.arm.markers.push_back({0.1 * i + 0.05, 0.1 * i + 0.08, {1, 1, 1}});
    const View view = random_view_of(random, backbone);
    Renderer renderer;
    LightImage picture;
    renderer.render(scene, view, PixelKind::gray, picture);
    const auto is_marked = [&](double s) {
      return std::ranges::any_of(
          scene.arm.markers, [s](const MarkerRing& marker) { return s >= marker.s_from && s < marker.s_to; });
    };
    compare(picture.light, tube, view, is_marked, errors);
  });
  expect_small(errors);
}

// The mean of what samples x samples rays of a pixel show.
double mean_of_rays(const Tracer& tracer, const Ray& pixel, int samples) {
  double sum = 0;
  for (int j = 0; j < samples; ++j) {
    for (int i = 0; i < samples; ++i) {
      const Ray ray = moved(pixel, {(i + 0.5) / samples - 0.5, (j + 0.5) / samples - 0.5});
      sum += gray_of(light_of(tracer.stage(), tracer.hit(ray), ray));
    }
  }
  return sum / (samples * samples);
}

// Where everything stands in the way of everything, areas are held against the same surfaces, sampled.
TEST(Coverage, OfCrowdedScenesIsThatOfTheirRays) {
  Errors errors;
  for_random_cases(5, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0.003);
    const Backbone backbone = bent.backbone();
    const Scene scene = crowded_scene(random, bent, backbone);
    View view = random_view_of(random, backbone);
    Intrinsics lens = view.lens.intrinsics();
    lens.distortion = {-0.2, 0.05, 0.001, 0.001, 0};
    view.lens = Lens(lens);
    Renderer renderer;
    LightImage picture;
    renderer.render(scene, view, PixelKind::gray, picture);
    for (int v = 0; v < view.height; ++v) {
      for (int u = 0; u < view.width; ++u) {
        const auto ray = renderer.rays().ray(u, v);
        if (!ray) continue;
        const Tracer tracer(renderer.stage(), renderer.tiles().parts(u / Tiles::size, v / Tiles::size));
        const double found = picture.light.at(u, v), rough = mean_of_rays(tracer, *ray, 4);
        if (std::abs(found - rough) > 1e-4) errors.add(found - mean_of_rays(tracer, *ray, 32));
      }
    }
  });
  expect_small(errors);
}

}  // namespace
}  // namespace flexura
