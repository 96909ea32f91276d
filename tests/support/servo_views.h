#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "flexura/camera/view.h"
#include "flexura/math/so3.h"
#include "flexura/model/arm.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Returns an arm of three sections of 0.2 m with a bend limit of 120 degrees.
inline Arm servo_arm() {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.resize(3);
  for (Section& section : arm.sections) section.length = 0.2, section.max_bend = 2.1;
  return arm;
}

/// Returns two cameras with distorted lenses, 2 m away on +Z and on -X.
inline std::array<View, 2> servo_views() {
  std::array<View, 2> views;
  const std::array<Eigen::Vector3d, 2> ways = {Eigen::Vector3d::UnitZ(), -Eigen::Vector3d::UnitX()};
  for (std::size_t i = 0; i < 2; ++i) {
    views[i].lens = Lens({.fx = 900, .fy = 900, .distortion = {-0.1, 0.02, 0.001, -0.001, 0}});
    const Eigen::Vector3d z = -ways[i], x = z.cross(Eigen::Vector3d::UnitY());
    views[i].X_WC.rotation << x, z.cross(x), z;
    views[i].X_WC.position = Eigen::Vector3d(0, 0.3, 0) + 2 * ways[i];
  }
  return views;
}

/// Returns wrong models of these cameras: rotated by `angle` rad in a random direction, with focal lengths
/// changed by `share`.
inline std::array<View, 2> wrong_views(TestRandom& random, std::array<View, 2> views, double angle,
                                       double share) {
  for (View& view : views) {
    const Eigen::Vector3d axis = random.vector<3>(-1, 1).normalized();
    view.X_WC.rotation = (view.X_WC.rotation * so3_exp(angle * axis)).eval();
    Intrinsics lens = view.lens.intrinsics();
    const double zoom = random.integer(0, 1) == 1 ? 1 + share : 1 - share;
    lens.fx *= zoom, lens.fy *= zoom;
    view.lens = Lens(lens);
  }
  return views;
}

/// Returns random bends within `most` rad.
inline ArmState random_servo_state(TestRandom& random, const Arm& arm, double most) {
  ArmState state = ArmState::straight(arm.sections.size());
  for (Eigen::Vector2d& bend : state.bends) bend = most * random.vector<2>(-0.7, 0.7);
  return state;
}

}  // namespace flexura
