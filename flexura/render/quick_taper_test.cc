// Arms with and without taper, at their joints and ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "flexura/math/so3.h"
#include "tests/support/picture_difference.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

// Successive sections with random bends, each with its own taper up to `steepest`.
BentArm random_tapered_arm(TestRandom& random, double steepest) {
  BentArm bent;
  bent.arm.kind = ArmKind::spatial;
  const int count = random.integer(1, 4);
  bent.state = ArmState::straight(static_cast<std::size_t>(count));
  double radius = random.uniform(0.005, 0.05);
  for (Eigen::Vector2d& bend : bent.state.bends) {
    const double length = random.uniform(0.05, 0.6);
    const double end = std::max(0.004, radius + random.uniform(-steepest, steepest) * length);
    bent.arm.sections.push_back({.length = length, .radius = {radius, end}});
    radius = end;
    if (random.integer(0, 2) != 0) bend = random.vector<2>(-3, 3);
  }
  return bent;
}

// From `distance` away, at `angle` from the z of a point of the arm.
View view_of_place(TestRandom& random, const Pose& place, double distance, double angle,
                   double focal_length) {
  const double around = random.uniform(0, 2 * std::numbers::pi);
  const Eigen::Vector3d side =
      std::cos(around) * place.rotation.col(0) + std::sin(around) * place.rotation.col(1);
  const Eigen::Vector3d from =
      place.position + distance * (std::cos(angle) * place.rotation.col(2) + std::sin(angle) * side);
  return pinhole_view(look_at(from, place.position + random.vector<3>(-0.01, 0.01), {0.1, 1, 0.05}), 64, 48,
                      focal_length);
}

// With ambient and directional light, and rings.
SceneView scene_view_of(TestRandom& random, const BentArm& bent, const View& view) {
  SceneView scene_view{plain_scene(), view};
  scene_view.scene.light.directional = 0.7;
  scene_view.scene.background = {0.9, 0.9, 0.9};
  scene_view.scene.arm.tube = tube_of(bent.backbone());
  for (int i = random.integer(0, 8); i > 0; --i) {
    const double s = random.uniform(-0.02, bent.backbone().length());
    scene_view.scene.arm.markers.push_back({s, s + random.uniform(0.003, 0.03), {0.9, 0.9, 0.9}});
  }
  return scene_view;
}

// A ray meets pieces that lean far towards the camera some radii from its point nearest to the axis: nothing
// behind them may show through. Where tapers change, the contours of two pieces differ.
TEST(QuickTaper, HasNoHolesAndAgreesWithTheExactWayWhereTapersChange) {
  compare_paths_of("arms of changing taper", 200, 0.04, [](TestRandom& random) {
    const BentArm bent = random_tapered_arm(random, random.integer(0, 1) == 0 ? 0 : 0.0999);
    const Backbone backbone = bent.backbone();
    View view = random_view_of(random, backbone);
    const double distance = random.integer(0, 1) == 0 ? 1 : std::pow(10, random.uniform(0, 2));
    if (distance > 1)
      view.X_WC.position = backbone.pose(random.uniform(0, 1) * backbone.length()).position -
                           distance * view.X_WC.rotation.col(2);
    view = pinhole_view(view.X_WC, 64, 48, 200 * distance * random.uniform(0.5, 5));
    Intrinsics intrinsics = view.lens.intrinsics();
    if (random.integer(0, 2) == 0) intrinsics.distortion[0] = random.uniform(-0.2, 0.2);
    view.lens = Lens(intrinsics);
    return scene_view_of(random, bent, view);
  });
}

// They differ by many radii where the joint is seen at a small angle to the axis, down to the limit of the
// fast path.
TEST(QuickTaper, AgreesWithTheExactWayWhereTapersChangeAndLean) {
  compare_paths_of("joints that lean", 80, 0.04, [](TestRandom& random) {
    BentArm bent;
    bent.arm.kind = ArmKind::spatial;
    bent.state = ArmState::straight(2);
    const double length = 0.2, radius = random.uniform(0.03, 0.04);
    for (const std::size_t i : {0U, 1U}) {
      const double other = radius + length * random.uniform(-0.0999, 0.0999);
      bent.arm.sections.push_back(
          {.length = length, .radius = i == 0 ? std::array{other, radius} : std::array{radius, other}});
      if (random.integer(0, 1) == 0) bent.state.bends[i] = random.vector<2>(-0.5, 0.5);
    }
    const double cosine = std::sqrt(random.uniform(0.75, 0.93)) * (random.integer(0, 1) == 0 ? 1 : -1);
    return scene_view_of(random, bent,
                         view_of_place(random, bent.backbone().pose(length), 3, std::acos(cosine),
                                       random.uniform(10, 30) * 3 / radius));
  });
}

// From all sides that show an end's face, also near its axis; nothing continues at the ends.
TEST(QuickTaper, AgreesWithTheExactWayAtTheEndsOfTheArm) {
  compare_paths_of("ends of tapered arms", 120, 0.04, [](TestRandom& random) {
    const BentArm bent = random_tapered_arm(random, random.integer(0, 1) == 0 ? 0.0999 : 0.02);
    const bool is_tip = random.integer(0, 1) == 1;
    const Pose end = bent.backbone().pose(is_tip ? bent.backbone().length() : 0);
    const double angle = random.uniform(0, 1.7), around = random.uniform(0, 2 * std::numbers::pi);
    const Eigen::Vector3d axis = (is_tip ? 1 : -1) * end.rotation.col(2);
    const Eigen::Vector3d side =
        std::cos(around) * end.rotation.col(0) + std::sin(around) * end.rotation.col(1);
    const double distance = random.uniform(0.5, 2), radius = bent.arm.sections.front().radius[0];
    const Eigen::Vector3d from = end.position + distance * (std::cos(angle) * axis + std::sin(angle) * side);
    const Pose X_WC = look_at(from, end.position + random.vector<3>(-0.01, 0.01), {0.1, 1, 0.05});
    return scene_view_of(random, bent,
                         pinhole_view(X_WC, 64, 48, 64 * distance / (random.uniform(1.5, 6) * radius)));
  });
}

}  // namespace
}  // namespace flexura
