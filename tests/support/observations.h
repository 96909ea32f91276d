#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_variables.h"
#include "flexura/model/backbone.h"
#include "tests/support/random_cases.h"
#include "tests/support/shape_error.h"

namespace flexura {

/// An arm of three sections, a metre long, at the world's origin.
inline Arm three_section_arm() {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.resize(3, {.length = 1.0 / 3});
  return arm;
}

inline ArmState random_bends(TestRandom& random, const Arm& arm, double most) {
  ArmState state = ArmState::straight(arm.sections.size());
  for (Eigen::Vector2d& bend : state.bends) bend = most * random.vector<2>(-0.7, 0.7);
  return state;
}

/// A camera at `eye` that looks at `at`, its image's v downwards in W.
inline View view_from(const Eigen::Vector3d& eye, const Eigen::Vector3d& at, double focal_length) {
  View view;
  view.lens = Lens({.fx = focal_length, .fy = focal_length});
  const Eigen::Vector3d z = (at - eye).normalized(), x = z.cross(Eigen::Vector3d::UnitY()).normalized();
  view.X_WC.rotation << x, z.cross(x), z;
  view.X_WC.position = eye;
  return view;
}

/// The paper's two: one on +Z, one on -X.
inline std::array<View, 2> two_views(double distance = 2.5) {
  const Eigen::Vector3d middle(0, 0.4, 0);
  return {view_from(middle + Eigen::Vector3d(0, 0, distance), middle, 800),
          view_from(middle - Eigen::Vector3d(distance, 0, 0), middle, 800)};
}

/// What a camera sees of a backbone, between two shares of its length, with normal noise across.
inline Observation observation_of(const Backbone& backbone, const View& view, TestRandom& random,
                                  double sigma, std::array<double, 2> shares = {0, 1},
                                  std::size_t count = 120) {
  Observation seen;
  seen.view = view;
  for (std::size_t i = 0; i < count; ++i) {
    const double f = static_cast<double>(i) / static_cast<double>(count - 1);
    const double s = ((1 - f) * shares[0] + f * shares[1]) * backbone.length();
    const Pose X_WS = backbone.pose(std::min(s, backbone.length()));
    const Eigen::Vector2d pixel = view.project(X_WS.position).value();
    const Eigen::Vector2d ahead = view.project(X_WS.position + 1e-4 * X_WS.rotation.col(2)).value() - pixel;
    const Eigen::Vector2d across = Eigen::Vector2d(-ahead.y(), ahead.x()).normalized();
    double noise = 0;  // The sum of twelve is nearly normal.
    for (int k = 0; k < 12; ++k) noise += random.uniform(-0.5, 0.5);
    seen.points.push_back({pixel + sigma * noise * across, std::max(sigma, 0.01)});
  }
  if (shares[0] == 0) seen.ends[0] = SeenEnd{seen.points.front().pixel};
  if (shares[1] == 1) seen.ends[1] = SeenEnd{seen.points.back().pixel};
  return seen;
}

/// What both of the paper's cameras see of it.
inline std::vector<Observation> observations_of(const Backbone& backbone, TestRandom& random, double sigma) {
  std::vector<Observation> seen;
  for (const View& view : two_views()) seen.push_back(observation_of(backbone, view, random, sigma));
  return seen;
}

}  // namespace flexura
