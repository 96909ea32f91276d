#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "flexura/vision/axis_curve.h"
#include "tests/support/seen_arms.h"

namespace flexura {

/// Returns a picture of a planar arm 400 px long that is completely visible.
inline SeenArm plain_arm(double bend, const SeenArmConfig& options = {}) {
  SeenArm seen;
  BentArm bent;
  bent.arm.kind = ArmKind::spatial;
  seen.radius = 0.02;
  for (int i = 0; i < 2; ++i)
    bent.arm.sections.push_back({.length = 0.4, .radius = {seen.radius, seen.radius}});
  bent.state = ArmState::straight(2);
  bent.state.bends = {{0, bend}, {0, -bend}};
  seen.scene.background = Color::Constant(0.85);
  seen.scene.arm.tube = tube_of(bent.backbone());
  seen.view =
      pinhole_view(look_at({0, 0.4, 1.6}, {0, 0.4, 0}), options.width, options.height, 1.25 * options.width);
  seen.picture = photograph(seen.scene, seen.view, options, 1);
  seen.truth = true_axis(seen.scene, seen.view, 2001);
  return seen;
}

/// Returns the rms distance of the samples from the true backbone, px.
inline double rms_error(const SeenArm& seen, const std::vector<AxisSample>& axis) {
  double squares = 0, count = 0;
  for (const AxisSample& sample : axis) {
    if (!sample.is_seen) continue;
    const double distance = distance_to(seen.truth, sample.pixel);
    squares += distance * distance, ++count;
  }
  return std::sqrt(squares / count);
}

/// Returns an arm of three sections of 0.3 m seen from the front.
inline SeenArm bent_arm_in_view(const std::vector<Eigen::Vector2d>& bends, double radius,
                                const Eigen::Vector3d& from, const Eigen::Vector3d& to, double focal_length) {
  SeenArm seen;
  BentArm bent;
  bent.arm.kind = ArmKind::spatial;
  bent.arm.sections.resize(bends.size(), {.length = 0.3, .radius = {radius, radius}});
  bent.state = ArmState::straight(bends.size());
  bent.state.bends = bends;
  seen.radius = radius;
  seen.scene.background = Color::Constant(0.85);
  seen.scene.arm.tube = tube_of(bent.backbone());
  seen.view = pinhole_view(look_at(from, to), 640, 480, focal_length);
  seen.picture = photograph(seen.scene, seen.view, {.noise = 1}, 3);
  seen.truth = true_axis(seen.scene, seen.view, 2001);
  return seen;
}

}  // namespace flexura
