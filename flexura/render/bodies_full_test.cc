// Guide disks, the etalon and obstacles, cut by each other and by the arm, against bodies that are known as
// functions of space.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "flexura/render/prepared_scene.h"
#include "flexura/render/ray_field.h"
#include "flexura/render/renderer.h"
#include "tests/support/coverage_errors.h"
#include "tests/support/frustums.h"
#include "tests/support/implicit_bodies.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

// A scene twice: as it is drawn and as its bodies, which show their gray level from all sides.
struct KnownScene {
  struct Body {
    ImplicitBody body;
    double gray;
  };
  Scene scene = plain_scene();
  std::vector<Body> bodies;
  std::optional<FrustumTube> arm;
  double arm_gray = 0;

  void add(const ObstacleConfig& obstacle, double gray) {
    scene.obstacles.push_back({obstacle, Color::Constant(gray)});
    for (const ImplicitBody& body : implicit_bodies(obstacle)) bodies.push_back({body, gray});
  }
  // What is seen from `eye` in a direction, near which only these frustums of the arm are.
  [[nodiscard]] double gray(const std::vector<FrustumTube::Frustum>& near, const Eigen::Vector3d& eye,
                            const Eigen::Vector3d& direction) const {
    double depth = ImplicitBody::nowhere, result = 0;
    for (const Body& body : bodies) {
      const double entry = body.body.entry(eye, direction);
      if (entry < depth) depth = entry, result = body.gray;
    }
    if (scene.etalon) {
      const double entry = implicit_etalon(*scene.etalon).entry(eye, direction);
      const bool is_line = entry < depth && is_on_etalon_line(*scene.etalon, eye + entry * direction);
      if (entry < depth) result = gray_of(is_line ? scene.etalon->line_albedo : scene.etalon->albedo);
      depth = std::min(depth, entry);
    }
    if (!near.empty() && FrustumTube::meet(near, eye, direction).depth < depth) result = arm_gray;
    return result;
  }
};

double mean_gray(const KnownScene& known, const std::vector<FrustumTube::Frustum>& near, const View& view,
                 int u, int v, int samples) {
  double sum = 0;
  for (int j = 0; j < samples; ++j) {
    for (int i = 0; i < samples; ++i) {
      const auto ray = ray_at(view.lens, {u - 0.5 + (i + 0.5) / samples, v - 0.5 + (j + 0.5) / samples});
      if (ray) sum += known.gray(near, view.X_WC.position, view.X_WC.rotation * ray->direction);
    }
  }
  return sum / (samples * samples);
}

void compare_known(const KnownScene& known, const View& view, BothCoverageErrors& errors) {
  Renderer renderer;
  LightImage exact, quick;
  renderer.render(known.scene, view, PixelKind::gray, exact, true);
  renderer.render(known.scene, view, PixelKind::gray, quick);
  for (int v = 0; v < view.height; ++v) {
    for (int u = 0; u < view.width; ++u) {
      const auto ray = renderer.prepared().rays.ray(u, v);
      if (!ray) continue;
      const auto near = known.arm ? known.arm->near(view.X_WC.position, view.X_WC.rotation * ray->direction,
                                                    renderer.prepared().rays.largest_step())
                                  : std::vector<FrustumTube::Frustum>();
      const double in_exact = exact.light.at(u, v), in_quick = quick.light.at(u, v);
      const double rough = mean_gray(known, near, view, u, v, 4);
      if (std::abs(in_exact - rough) < 1e-4 && std::abs(in_quick - rough) < 1e-4) continue;
      const double expected = mean_gray(known, near, view, u, v, 64);
      errors.exact.add(in_exact - expected);
      errors.quick.add(in_quick - expected);
    }
  }
}

// A camera that looks at the origin from 1 to 2 m, half of the time through a distorting lens.
View view_of_origin(TestRandom& random) {
  const Eigen::Vector3d from = random.vector<3>(-1, 1).normalized() * random.uniform(1, 2);
  View view = pinhole_view(look_at(from, random.vector<3>(-0.1, 0.1), {0.1, 1, 0.05}), 96, 72,
                           random.uniform(80, 250));
  Intrinsics lens = view.lens.intrinsics();
  if (random.integer(0, 1) == 0) lens.distortion = {-0.2, 0.05, 0.001, 0.001, 0};
  view.lens = Lens(lens);
  return view;
}

std::array<double, 3> near_origin(TestRandom& random) {
  const Eigen::Vector3d p = random.vector<3>(-0.25, 0.25);
  return {p.x(), p.y(), p.z()};
}

void add_obstacles(TestRandom& random, KnownScene& known) {
  known.add(SphereConfig{.center = near_origin(random), .radius = random.uniform(0.05, 0.2)}, 1);
  const auto from = near_origin(random);
  known.add(CapsuleConfig{.from = from, .to = near_origin(random), .radius = random.uniform(0.02, 0.1)}, 0.6);
  const Eigen::Vector4d turn = random.vector<4>(-1, 1);
  known.add(BoxConfig{.center = near_origin(random),
                      .half_sizes = {random.uniform(0.05, 0.2), 0.1, 0.05},
                      .rotation = {turn[0], turn[1], turn[2], turn[3]}},
            0.3);
}

TEST(BodyCoverage, OfObstaclesThatCutEachOtherIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(12, [&](TestRandom& random) {
    KnownScene known;
    add_obstacles(random, known);
    if (random.integer(0, 1) == 0) known.add(PlaneConfig{.point = {0, -0.2, 0}}, 0.8);
    compare_known(known, view_of_origin(random), errors);
  });
  errors.expect_small();
}

TEST(BodyCoverage, OfTheEtalonAmongObstaclesIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(12, [&](TestRandom& random) {
    KnownScene known;
    Etalon& etalon = known.scene.etalon.emplace();
    const auto place = near_origin(random);
    etalon.X_WE = {so3_exp(random.vector<3>(-2, 2)), {place[0], place[1], place[2]}};
    etalon.radius = random.uniform(0.04, 0.15), etalon.height = random.uniform(0.2, 0.6);
    etalon.line_width = random.uniform(0.004, 0.03);
    etalon.albedo = Color::Constant(0.1), etalon.line_albedo = Color::Constant(1);
    if (random.integer(0, 1) == 0) add_obstacles(random, known);
    compare_known(known, view_of_origin(random), errors);
  });
  errors.expect_small();
}

// With `wildness` 1 the arm keeps clear of its disks, but for the one at hand, with more it passes through.
void compare_known_disks(TestRandom& random, double wildness, BothCoverageErrors& errors) {
  BentArm bent = random_bent_arm(random, 0, 0.008);
  for (Eigen::Vector2d& bend : bent.state.bends) bend *= wildness;
  const Backbone backbone = bent.backbone();
  constexpr int frustums = 300;  // a section
  KnownScene known;
  known.arm.emplace(bent.arm, backbone, frustums);
  known.arm_gray = 0.2;
  known.scene.arm.tube = tube_of(bent.arm, backbone);
  known.scene.arm.albedo = Color::Constant(0.2), known.scene.arm.disk_albedo = Color::Constant(1);
  const double step = backbone.arcs()[1].s;
  known.scene.arm.disks = {{step, 0.05, 0.01}, {step + random.uniform(-0.1, 0.1), 0.06, 0.004}};
  for (const GuideDisk& disk : known.scene.arm.disks)
    known.bodies.push_back({implicit_disk(backbone.pose(disk.s), disk), 1});
  const View around = random_view_of(random, backbone);
  const View view = pinhole_view(look_at(around.X_WC.position, backbone.pose(step).position), 96, 72,
                                 random.uniform(200, 500));
  compare_known(known, view, errors);
}

TEST(BodyCoverage, OfGuideDisksIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(10, [&](TestRandom& random) { compare_known_disks(random, 1, errors); });
  errors.expect_small();
}

TEST(BodyCoverage, OfGuideDisksThatTheArmPassesThroughIsThatOfManySamples) {
  BothCoverageErrors errors;
  for_random_cases(10, [&](TestRandom& random) { compare_known_disks(random, 2.5, errors); });
  errors.expect_small();
}

}  // namespace
}  // namespace flexura
