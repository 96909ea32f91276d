#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "flexura/camera/view.h"
#include "flexura/model/backbone.h"
#include "flexura/render/scene.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// A camera at `from` that looks at `to`, the right way up but for `tilted`.
inline Pose look_at(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                    const Eigen::Vector3d& up = {0, 1, 0}) {
  const Eigen::Vector3d z = (to - from).normalized(), x = z.cross(up).normalized();
  Pose X_WC;
  X_WC.rotation << x, z.cross(x), z;
  X_WC.position = from;
  return X_WC;
}

/// Without distortion, the optical axis through the image's middle.
inline View pinhole_view(const Pose& X_WC, int width, int height, double focal_length) {
  View view;
  view.lens =
      Lens({.fx = focal_length, .fy = focal_length, .cx = 0.5 * (width - 1), .cy = 0.5 * (height - 1)});
  view.X_WC = X_WC;
  view.width = width;
  view.height = height;
  return view;
}

/// Nothing in it; what is put in shows its albedo as it is.
inline Scene plain_scene() {
  Scene scene;
  scene.light.ambient = 1;
  scene.light.directional = 0;
  scene.background = Color::Zero();
  return scene;
}

/// A spatial arm of three sections, 1 m long, bent anyhow; each section thins by `taper`.
struct BentArm {
  Arm arm;
  ArmState state;

  [[nodiscard]] Backbone backbone() const { return {arm, state}; }
};
inline BentArm random_bent_arm(TestRandom& random, double taper) {
  BentArm bent;
  bent.arm.kind = ArmKind::spatial;
  double radius = 0.025;
  for (int i = 0; i < 3; ++i) {
    Section& section = bent.arm.sections.emplace_back();
    section.length = 0.33;
    section.radius = {radius, radius - taper};
    radius -= taper;
  }
  bent.state = ArmState::straight(3);
  for (Eigen::Vector2d& bend : bent.state.bends) bend = random.vector<2>(-2, 2);
  return bent;
}

/// A camera that sees some of an arm of 1 m from any side, near or far.
inline View random_view_of(TestRandom& random, const Backbone& backbone) {
  const Eigen::Vector3d middle = backbone.pose(0.5 * backbone.length()).position;
  const Eigen::Vector3d direction = random.vector<3>(-1, 1).normalized();
  return pinhole_view(look_at(middle + direction * random.uniform(0.6, 1.6),
                              middle + random.vector<3>(-0.1, 0.1), {0.1, 1, 0.05}),
                      160, 120, 200);
}

}  // namespace flexura
