#pragma once

#include <Eigen/Geometry>
#include <array>
#include <numeric>

#include "flexura/camera/view.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"
#include "flexura/render/scene.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Returns the pose of a camera at `from` that looks at `to`, with `up` upwards in the image.
inline Pose look_at(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                    const Eigen::Vector3d& up = {0, 1, 0}) {
  const Eigen::Vector3d z = (to - from).normalized(), x = z.cross(up).normalized();
  Pose X_WC;
  X_WC.rotation << x, z.cross(x), z;
  X_WC.position = from;
  return X_WC;
}

/// Returns a view without distortion, with the optical axis through the image centre.
inline View pinhole_view(const Pose& X_WC, int width, int height, double focal_length) {
  View view;
  view.lens =
      Lens({.fx = focal_length, .fy = focal_length, .cx = 0.5 * (width - 1), .cy = 0.5 * (height - 1)});
  view.X_WC = X_WC;
  view.width = width;
  view.height = height;
  return view;
}

/// Returns an empty scene in which objects appear with their albedo.
inline Scene plain_scene() {
  Scene scene;
  scene.light.ambient = 1;
  scene.light.directional = 0;
  scene.background = Color::Zero();
  return scene;
}

/// A randomly bent spatial arm of three sections, 1 m long. Each section tapers by `taper`, and the next one
/// starts up to `step` narrower or wider.
struct BentArm {
  Arm arm;
  ArmState state;

  [[nodiscard]] Backbone backbone() const { return {arm, state}; }
};
inline BentArm random_bent_arm(TestRandom& random, double taper, double step = 0) {
  BentArm bent;
  bent.arm.kind = ArmKind::spatial;
  double radius = 0.025;
  for (int i = 0; i < 3; ++i) {
    Section& section = bent.arm.sections.emplace_back();
    section.length = 0.33;
    section.radius = {radius, radius - taper};
    radius -= taper;
    if (step > 0) radius += random.uniform(-step, step);
  }
  bent.state = ArmState::straight(3);
  for (Eigen::Vector2d& bend : bent.state.bends) bend = random.vector<2>(-2, 2);
  return bent;
}

/// Returns a gray scene with many occlusions: the arm with markers and disks, a screen, the calibration
/// cylinder, and an obstacle of each kind.
inline Scene crowded_scene(TestRandom& random, const Backbone& backbone) {
  Scene scene = plain_scene();
  const auto gray = [](double value) { return Color(value, value, value); };
  scene.arm.tube = tube_of(backbone);
  scene.arm.tip = random.integer(0, 1) == 0 ? TipKind::flat : TipKind::round;
  scene.arm.albedo = gray(0.2), scene.arm.disk_albedo = gray(0.5);
  for (int i = 0; i < 9; ++i) scene.arm.markers.push_back({0.1 * i + 0.05, 0.1 * i + 0.08, gray(0.7)});
  for (int i = 0; i < 5; ++i) scene.arm.disks.push_back({0.2 * i + 0.1, 0.04, 0.006});
  const Eigen::Vector3d middle = backbone.pose(0.5 * backbone.length()).position;
  const auto place = [&] { return Eigen::Vector3d(middle + random.vector<3>(-0.4, 0.4)); };
  const auto listed = [](const Eigen::Vector3d& p) { return std::array<double, 3>{p.x(), p.y(), p.z()}; };
  Screen& screen = scene.screens.emplace_back();
  screen.X_WS = {so3_exp(random.vector<3>(-1, 1)), place()};
  screen.size = {0.5, 0.6};
  screen.brightness = gray(1);
  Etalon& etalon = scene.etalon.emplace();
  etalon.X_WE = {so3_exp(random.vector<3>(-2, 2)), place()};
  etalon.line_width = 0.02;
  etalon.albedo = gray(0.1), etalon.line_albedo = gray(0.9);
  scene.obstacles.push_back({SphereConfig{.center = listed(place()), .radius = 0.1}, gray(0.3)});
  const auto from = listed(place());
  scene.obstacles.push_back({CapsuleConfig{.from = from, .to = listed(place()), .radius = 0.05}, gray(0.4)});
  scene.obstacles.push_back(
      {BoxConfig{.center = listed(place()), .half_sizes = {0.1, 0.1, 0.05}, .rotation = {1, 0.3, 0.2, 0.1}},
       gray(0.6)});
  scene.obstacles.push_back({PlaneConfig{.point = {0, middle.y() - 0.5, 0}}, gray(0.8)});
  return scene;
}

/// Returns a random camera, near or far, that sees part of an arm of 1 m from any side.
inline View random_view_of(TestRandom& random, const Backbone& backbone) {
  const Eigen::Vector3d middle = backbone.pose(0.5 * backbone.length()).position;
  const Eigen::Vector3d direction = random.vector<3>(-1, 1).normalized();
  return pinhole_view(look_at(middle + direction * random.uniform(0.6, 1.6),
                              middle + random.vector<3>(-0.1, 0.1), {0.1, 1, 0.05}),
                      160, 120, 200);
}

inline double sum_of(const Image<float>& image) {
  return std::accumulate(image.values().begin(), image.values().end(), 0.0);
}

}  // namespace flexura
