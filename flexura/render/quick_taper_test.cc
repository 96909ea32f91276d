#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "flexura/math/so3.h"
#include "flexura/render/renderer.h"
#include "tests/support/picture_difference.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

// Sections one after the other, each with a taper of its own up to `steepest`, bent anyhow.
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

// At one of its ends, from any side on which the end's face is seen, near its axis too.
View view_of_an_end(TestRandom& random, const BentArm& bent) {
  const Backbone backbone = bent.backbone();
  const bool is_tip = random.integer(0, 1) == 1;
  const Pose end = backbone.pose(is_tip ? backbone.length() : 0);
  const double angle = random.uniform(0, 1.7), around = random.uniform(0, 2 * std::numbers::pi);
  const Eigen::Vector3d axis = (is_tip ? 1 : -1) * end.rotation.col(2);
  const Eigen::Vector3d side =
      std::cos(around) * end.rotation.col(0) + std::sin(around) * end.rotation.col(1);
  const double distance = random.uniform(0.5, 2), radius = bent.arm.sections.front().radius[0];
  const Eigen::Vector3d from = end.position + distance * (std::cos(angle) * axis + std::sin(angle) * side);
  return pinhole_view(look_at(from, end.position + random.vector<3>(-0.01, 0.01), {0.1, 1, 0.05}), 64, 48,
                      64 * distance / (random.uniform(1.5, 6) * radius));
}

// At some place of it, near or through a long lens.
View view_of_a_place(TestRandom& random, const BentArm& bent) {
  const Backbone backbone = bent.backbone();
  View view = random_view_of(random, backbone);
  const double distance = random.integer(0, 1) == 0 ? 1 : std::pow(10, random.uniform(0, 2));
  if (distance > 1)
    view.X_WC.position = backbone.pose(random.uniform(0, 1) * backbone.length()).position -
                         distance * view.X_WC.rotation.col(2);
  view = pinhole_view(view.X_WC, 64, 48, 200 * distance * random.uniform(0.5, 5));
  if (random.integer(0, 2) != 0) return view;
  Intrinsics intrinsics = view.lens.intrinsics();
  intrinsics.distortion[0] = random.uniform(-0.2, 0.2);
  view.lens = Lens(intrinsics);
  return view;
}

// Straight, at a joint of it, looking along it as steeply as the quick way still draws.
View steep_view_of_a_joint(TestRandom& random, const BentArm& bent) {
  const Backbone backbone = bent.backbone();
  const Pose joint = backbone.pose(bent.arm.sections.front().length);
  const double cosine = std::sqrt(random.uniform(0.75, 0.93)) * (random.integer(0, 1) == 0 ? 1 : -1);
  const double around = random.uniform(0, 2 * std::numbers::pi), sine = std::sqrt(1 - cosine * cosine);
  const Eigen::Vector3d side =
      std::cos(around) * joint.rotation.col(0) + std::sin(around) * joint.rotation.col(1);
  const Eigen::Vector3d from = joint.position - 3 * (cosine * joint.rotation.col(2) + sine * side);
  const double radius = bent.arm.sections.front().radius[1];
  return pinhole_view(look_at(from, joint.position + random.vector<3>(-0.01, 0.01), {0.1, 1, 0.05}), 96, 72,
                      random.uniform(10, 30) * 3 / radius);
}

// The worst difference of light that the two ways make of random arms.
double worst_of(TestRandom& random, const BentArm& bent, const View& view) {
  Scene scene = plain_scene();
  scene.light.directional = 0.7;
  scene.background = {0.9, 0.9, 0.9};
  scene.arm.tube = tube_of(bent.arm, bent.backbone());
  for (int i = random.integer(0, 8); i > 0; --i) {
    const double s = random.uniform(-0.02, bent.backbone().length());
    scene.arm.markers.push_back({s, s + random.uniform(0.003, 0.03), {0.9, 0.9, 0.9}});
  }
  const Difference off = compare_ways(scene, view);
  EXPECT_LT(off.worst, 0.04);
  EXPECT_LE(off.bad_depths, 4);  // Off by a little more than 2e-6 of it; a hole shows in the light.
  return off.worst;
}

// Of so many arms as `draw` makes them, each with a view of it.
template <typename Draw>
void compare_ways_of(const char* name, int count, Draw&& draw) {
  double worst = 0;
  for_random_cases(count, [&](TestRandom& random) {
    const std::pair<BentArm, View> drawn = draw(random);
    worst = std::max(worst, worst_of(random, drawn.first, drawn.second));
  });
  std::printf("%s: light differs by %.5f at worst\n", name, worst);
}

// Pieces that lean far towards the camera are met some radii along the ray from where it is near their axis:
// nothing behind them is seen through them.
TEST(QuickTaper, HasNoHolesWhereThereIsNoTaperEither) {
  compare_ways_of("arms without taper", 300, [](TestRandom& random) {
    const BentArm bent = random_tapered_arm(random, 0);
    return std::pair(bent, view_of_a_place(random, bent));
  });
}

// Where tapers change the contours of two pieces part; at the ends of the arm nothing goes on.
TEST(QuickTaper, AgreesWithTheExactWayWhereTapersChange) {
  compare_ways_of("arms of changing taper", 200, [](TestRandom& random) {
    const BentArm bent = random_tapered_arm(random, 0.0999);
    return std::pair(bent, view_of_a_place(random, bent));
  });
}

// They part by many radii where the joint is looked at from near its axis.
TEST(QuickTaper, AgreesWithTheExactWayWhereTapersChangeAndLean) {
  compare_ways_of("joints that lean", 100, [](TestRandom& random) {
    BentArm bent;
    bent.arm.kind = ArmKind::spatial;
    bent.state = ArmState::straight(2);
    const double length = 0.2, radius = random.uniform(0.03, 0.04);
    for (const int before : {1, 0}) {
      const double other = radius + length * random.uniform(-0.0999, 0.0999);
      bent.arm.sections.push_back(
          {.length = length, .radius = before == 1 ? std::array{other, radius} : std::array{radius, other}});
      if (random.integer(0, 1) == 0)
        bent.state.bends[bent.arm.sections.size() - 1] = random.vector<2>(-0.5, 0.5);
    }
    return std::pair(bent, steep_view_of_a_joint(random, bent));
  });
}

TEST(QuickTaper, AgreesWithTheExactWayAtTheEndsOfTheArm) {
  compare_ways_of("ends of tapered arms", 200, [](TestRandom& random) {
    const BentArm bent = random_tapered_arm(random, random.integer(0, 1) == 0 ? 0.0999 : 0.02);
    return std::pair(bent, view_of_an_end(random, bent));
  });
}

}  // namespace
}  // namespace flexura
