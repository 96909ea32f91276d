// Compares depths with thousands of cone frustums; checks the exact surface for seams.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "flexura/render/prepared_scene.h"
#include "flexura/render/renderer.h"
#include "flexura/render/tracer.h"
#include "tests/support/frustums.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

TEST(Depth, IsThatOfFrustumsWhereRaysDoNotGraze) {
  double largest = 0;
  int compared = 0;
  for_random_cases(6, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0.005);
    const Backbone backbone = bent.backbone();
    Scene scene = plain_scene();
    scene.arm.tube = tube_of(backbone);
    const View view = random_view_of(random, backbone);
    Renderer renderer;
    renderer.prepare(scene, view);
    const FrustumTube frustums(bent.arm, backbone, 600);
    const Tracer tracer(renderer.prepared().stage, renderer.prepared().tiles.all_parts());
    for (int v = 0; v < view.height; ++v) {
      for (int u = 0; u < view.width; ++u) {
        const Ray ray = *ray_at(view.lens, {u, v});
        const Hit hit = tracer.hit(ray);
        if (hit.label.kind != SurfaceKind::section) continue;
        if (std::abs(hit.normal.dot(ray.direction.normalized())) < 0.2) continue;
        // Skips rays that pass a silhouette by less than the error of the frustums.
        if (tracer.trace(ray).nearest.distance < 0.2) continue;
        const Eigen::Vector3d direction = view.X_WC.rotation * ray.direction;
        const auto near =
            frustums.near(view.X_WC.position, direction, renderer.prepared().rays.largest_step());
        const double expected = FrustumTube::meet(near, view.X_WC.position, direction).depth;
        largest = std::max(largest, std::abs(hit.depth - expected) / hit.depth);
        ++compared;
      }
    }
  });
  std::printf("%d depths, largest relative difference %.2e\n", compared, largest);
  EXPECT_GT(compared, 2000);
  EXPECT_LT(largest, 1e-5);
}

// Compares the jumps of depth and normal along a line of pixels across s with their changes elsewhere.
TEST(Depth, HasNoSeamWhereSectionsMeet) {
  for_random_cases(5, [](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0);
    const Backbone backbone = bent.backbone();
    Scene scene = plain_scene();
    scene.arm.tube = tube_of(backbone);
    const Pose X_WS = backbone.pose(0.33);  // Sections 0 and 1 meet here.
    const double angle = random.uniform(-3, 3);
    const Eigen::Vector3d out = X_WS.rotation * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
    Renderer renderer;
    renderer.prepare(
        scene,
        pinhole_view(look_at(X_WS.position + 0.5 * out, X_WS.position, X_WS.rotation.col(2)), 101, 101, 400));
    const Tracer tracer(renderer.prepared().stage, renderer.prepared().tiles.all_parts());
    Hit before;
    for (int i = -400; i <= 400; ++i) {
      const Hit hit = tracer.hit(*ray_at(renderer.prepared().view.lens, {50.2, 50 + 1e-3 * i}));
      if (i > -400 && std::abs(hit.s - 0.33) < 2e-4) {
        EXPECT_NEAR(hit.depth, before.depth, 2e-6);
        EXPECT_LT((hit.normal - before.normal).norm(), 1e-4);
        EXPECT_LT(std::abs(hit.s - before.s), 1e-5);
      }
      before = hit;
    }
  });
}

TEST(Depth, IsContinuousWhereASectionStraightens) {
  // Bends from 1e-3 to 0, past the threshold of the series.
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.push_back({.length = 1, .radius = {0.03, 0.02}});
  const View view = pinhole_view(look_at({0.3, 0.4, 1.5}, {0, 0.5, 0}), 120, 120, 150);
  const auto picture = [&](double bend) {
    ArmState state = ArmState::straight(1);
    state.bends[0] = {bend, 0.5 * bend};
    Scene scene = plain_scene();
    scene.arm.albedo = {1, 1, 1};
    scene.arm.tube = tube_of(Backbone(arm, state));
    Renderer renderer;
    LightImage result;
    renderer.render(scene, view, PixelKind::gray, result);
    return result;
  };
  const LightImage straight = picture(0);
  for (const double bend : {1e-12, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3}) {
    const LightImage bent = picture(bend);
    double light = 0, depth = 0;
    for (std::size_t i = 0; i < bent.light.values().size(); ++i) {
      light =
          std::max(light, static_cast<double>(std::abs(bent.light.values()[i] - straight.light.values()[i])));
      const double a = bent.depth.values()[i], b = straight.depth.values()[i];
      if (std::isfinite(a) && std::isfinite(b)) depth = std::max(depth, std::abs(a - b));
    }
    // The tip moves by 0.56 bend m, up to 70 bend px; squares at its corners are sampled.
    EXPECT_LT(light, 100 * bend + 2e-4) << bend;
    EXPECT_LT(depth, 3 * std::sqrt(bend) * 0.03 + 2e-6) << bend;
  }
}

TEST(Coverage, OfAGeneralBackboneConvergesToTheArcs) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (int i = 0; i < 3; ++i) arm.sections.push_back({.length = 0.33, .radius = {0.02, 0.02}});
  ArmState state = ArmState::straight(3);
  state.bends = {{1.2, 0.4}, {-0.5, 1.5}, {-1.8, -1.0}};
  const Backbone backbone(arm, state);
  const View view = pinhole_view(look_at({0.4, 0.6, 1.8}, {0.1, 0.5, 0}), 160, 120, 150);
  const auto light_of = [&](const std::vector<Arc>& tube) {
    Scene scene = plain_scene();
    scene.arm.albedo = {1, 1, 1};
    scene.arm.tube = tube;
    Renderer renderer;
    LightImage picture;
    renderer.render(scene, view, PixelKind::gray, picture);
    return picture.light;
  };
  const Image<float> exact = light_of(tube_of(backbone));
  double last = std::numeric_limits<double>::infinity();
  // Sample counts that never place a sample at a section end.
  for (const int count : {8, 32, 128}) {
    std::vector<BackboneSample> samples;
    for (int i = 0; i <= count; ++i) {
      const double s = backbone.length() * i / count;
      samples.push_back({backbone.pose(s), s, 0.02, 0});
    }
    const Image<float> light = light_of(tube_of(Backbone::through(samples)));
    double largest = 0;
    for (std::size_t i = 0; i < light.values().size(); ++i)
      largest = std::max(largest, static_cast<double>(std::abs(light.values()[i] - exact.values()[i])));
    std::printf("%d samples: largest difference of coverage %.5f\n", count, largest);
    EXPECT_LT(largest, 0.3 * last);
    last = largest;
  }
  EXPECT_LT(last, 0.01);
}

}  // namespace
}  // namespace flexura
