#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <numbers>

#include "flexura/math/so3.h"
#include "flexura/model/arm.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Returns the paper's arm (section 3.2) with its section lengths, straight along +Y.
inline Arm paper_arm() {
  Arm arm;
  for (const double length : {2.0, 3.0, 1.0, 2.0, 4.0, 2.0, 1.0, 1.0}) {
    Section& section = arm.sections.emplace_back();
    section.length = length;
  }
  return arm;
}

/// Returns the final cord angles of the paper's arm, measured from +X, rad.
inline std::array<double, 8> paper_cord_angles() {
  std::array<double, 8> angles = {.55, .65, .8, 1., 1.15, .9, .8, .65};
  for (double& angle : angles) angle *= std::numbers::pi;
  return angles;
}

/// Returns the final state of the paper's arm: archings .05 .05 .1 .1 .05 -.3 .2 -.35, in units of pi.
inline ArmState paper_state() {
  ArmState state = ArmState::straight(8);
  const std::array<double, 8> archings = {.05, .05, .1, .1, .05, -.3, .2, -.35};
  for (std::size_t i = 0; i < 8; ++i) state.bends[i].x() = -2.0 * archings[i] * std::numbers::pi;
  return state;
}

/// Returns an arm of one to six spatial sections with a random base pose.
inline Arm random_arm(TestRandom& random) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.X_WB = {so3_exp(random.vector<3>(-2.0, 2.0)), random.vector<3>(-1.0, 1.0)};
  const int count = random.integer(1, 6);
  for (int i = 0; i < count; ++i) {
    Section& section = arm.sections.emplace_back();
    section.length = random.uniform(0.2, 2.0);
  }
  return arm;
}

/// Returns a random state. Bends are 0, 1e-12, up to 0.1 rad or up to one and a half turns; stretches 0.7 to
/// 1.4.
inline ArmState random_state(TestRandom& random, const Arm& arm) {
  ArmState state = ArmState::straight(arm.sections.size());
  for (Eigen::Vector2d& bend : state.bends) {
    constexpr std::array<double, 4> scales = {0.0, 1e-12, 0.1, 9.4};
    const double scale = scales[static_cast<std::size_t>(random.integer(0, 3))];
    bend = scale * random.uniform(0.0, 1.0) * random.vector<2>(-1.0, 1.0).normalized();
  }
  for (double& stretch : state.stretches) stretch = random.uniform(0.7, 1.4);
  return state;
}

/// Packs a state into one vector with three numbers per section: bend_x, bend_y, stretch.
inline Eigen::VectorXd packed(const ArmState& state) {
  Eigen::VectorXd q(3 * static_cast<Eigen::Index>(state.bends.size()));
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    q.segment<3>(3 * static_cast<Eigen::Index>(i)) << state.bends[i], state.stretches[i];
  }
  return q;
}

/// Unpacks a vector made by packed().
inline ArmState unpacked(const Eigen::VectorXd& q) {
  ArmState state = ArmState::straight(static_cast<std::size_t>(q.size() / 3));
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    const Eigen::Vector3d part = q.segment<3>(3 * static_cast<Eigen::Index>(i));
    state.bends[i] = part.head<2>();
    state.stretches[i] = part[2];
  }
  return state;
}

}  // namespace flexura
