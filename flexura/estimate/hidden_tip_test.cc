#include "flexura/estimate/hidden_tip.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/model/backbone.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double radius = 0.015, focal = 800, given = 0.2;

// An arm whose tip is 2 m in front of a camera, and whose tip's direction makes this angle with the line of
// sight. `away`: azimuth of the tip's direction about the line of sight.
Shape arm_towards_camera(std::vector<Eigen::Vector2d> bends, double angle, double away) {
  Shape shape;
  shape.arm.kind = ArmKind::spatial;
  shape.arm.X_WB = Pose{};
  shape.arm.sections.resize(bends.size(), {.length = 0.25, .radius = {radius, radius}});
  shape.state = ArmState::straight(bends.size());
  shape.state.bends = std::move(bends);
  const Backbone backbone(shape.arm, shape.state);
  const Eigen::Vector3d out = backbone.pose(backbone.length()).rotation.col(2);
  const Eigen::Vector3d wanted(std::sin(angle) * std::cos(away), std::sin(angle) * std::sin(away),
                               -std::cos(angle));
  const Eigen::Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(out, wanted).toRotationMatrix();
  shape.arm.X_WB.rotation = turn;
  shape.arm.X_WB.position = Eigen::Vector3d(0, 0, 2) - turn * backbone.pose(backbone.length()).position;
  return shape;
}

double sigma_of_tip(const Shape& shape) {
  Observation seen;
  seen.view = {Lens(Intrinsics{.fx = focal, .fy = focal, .cx = 319.5, .cy = 239.5}), Pose{}, 640, 480};
  seen.ends[1] = SeenEnd{{319.5, 239.5}, given};
  distrust_hidden_tip(shape, 0, seen);
  return seen.ends[1]->sigma;
}

std::vector<Eigen::Vector2d> straight() { return {{0, 0}, {0, 0}, {0, 0}}; }

TEST(HiddenTip, IsTrustedFromTheSide) {
  for_random_cases(100, [](TestRandom& random) {
    const double angle = random.uniform(0.2, 0.8) * std::numbers::pi;
    EXPECT_EQ(sigma_of_tip(arm_towards_camera(straight(), angle, random.uniform(-3, 3))), given);
  });
}

TEST(HiddenTip, IsDistrustedEndOn) {
  for_random_cases(100, [](TestRandom& random) {
    const double angle = random.uniform(0, 0.15) + (random.uniform(0, 1) < 0.5 ? 0 : std::numbers::pi - 0.15);
    const double radius_px = focal * radius / 2;
    EXPECT_GT(sigma_of_tip(arm_towards_camera(straight(), angle, random.uniform(-3, 3))), radius_px);
  });
}

// The nearer to end-on, the larger the standard deviation.
TEST(HiddenTip, IsDistrustedGradually) {
  double before = given;
  for (double angle = 0.6; angle > 0.01; angle -= 0.01) {
    const double now = sigma_of_tip(arm_towards_camera(straight(), angle, 1));
    EXPECT_GE(now, before) << angle;
    EXPECT_LT(now, before + 20) << angle;
    before = now;
  }
}

// The last section turns back in front of the arm: the fold, not the tip, ends the silhouette.
TEST(HiddenTip, IsDistrustedInFrontOfTheArm) {
  const double radius_px = focal * radius / 2;
  Shape folded = arm_towards_camera({{0, 0}, {0, 0}, {std::numbers::pi, 0}}, 0, 0);
  // Turned so that the camera looks along the line from the tip to the arm's straight part.
  const Backbone backbone(folded.arm, folded.state);
  const Eigen::Vector3d tip = backbone.pose(backbone.length()).position, behind = backbone.pose(0.5).position;
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond::FromTwoVectors(behind - tip, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  folded.arm.X_WB.rotation = turn * folded.arm.X_WB.rotation;
  folded.arm.X_WB.position = Eigen::Vector3d(0, 0, 2) + turn * (folded.arm.X_WB.position - tip);
  EXPECT_GT(sigma_of_tip(folded), 5 * radius_px);
}

TEST(HiddenTip, IsTrustedWithoutARadius) {
  Shape shape = arm_towards_camera(straight(), 0, 0);
  for (Section& section : shape.arm.sections) section.radius = {0, 0};
  EXPECT_EQ(sigma_of_tip(shape), given);
}

}  // namespace
}  // namespace flexura
