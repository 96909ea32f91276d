#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/spatial.h"
#include "tests/support/random_cases.h"

// Targets for inverse kinematics that are known to be reachable or unreachable, for tests and studies.
namespace flexura {

enum class TargetKind { position, direction, pose };

/// Returns three spatial sections of 0.15 to 0.4 m with a common bend limit from 60 degrees to a half turn.
inline Arm random_three_sections(TestRandom& random) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  const double max_bend = random.uniform(1.0 / 3.0, 1.0) * std::numbers::pi;
  for (int i = 0; i < 3; ++i) {
    Section& section = arm.sections.emplace_back();
    section.length = random.uniform(0.15, 0.4);
    section.max_bend = max_bend;
  }
  return arm;
}

/// Returns a state distributed uniformly over the limits: disks of bends, ranges of stretches.
inline ArmState random_state_within(TestRandom& random, const Arm& arm) {
  ArmState state = ArmState::straight(arm.sections.size());
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const Section& section = arm.sections[i];
    const double widest = std::min(section.max_bend, 2.0 * std::numbers::pi);
    if (arm.kind == ArmKind::planar) {
      state.bends[i] = {random.uniform(-widest, widest), 0.0};
    } else {
      const double radius = widest * std::sqrt(random.uniform(0.0, 1.0));
      const double angle = random.uniform(-std::numbers::pi, std::numbers::pi);
      state.bends[i] = {radius * std::cos(angle), radius * std::sin(angle)};
    }
    state.stretches[i] = random.uniform(section.stretch_limits[0], section.stretch_limits[1]);
  }
  return state;
}

inline TipTarget target_at(const Pose& X_WT, TargetKind kind) {
  TipTarget target;
  target.position = X_WT.position;
  if (kind == TargetKind::direction) target.direction = X_WT.rotation.col(2);
  if (kind == TargetKind::pose) target.rotation = X_WT.rotation;
  return target;
}

inline bool is_within_limits(const Arm& arm, const ArmState& state) {
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const Section& section = arm.sections[i];
    if (!(state.bends[i].norm() <= section.max_bend)) return false;
    if (arm.kind == ArmKind::planar && state.bends[i].y() != 0.0) return false;
    const auto [low, high] = section.stretch_limits;
    if (!(state.stretches[i] >= low && state.stretches[i] <= high)) return false;
  }
  return true;
}

inline Eigen::Vector3d random_unit(TestRandom& random) {
  Eigen::Vector3d v = random.vector<3>(-1.0, 1.0);
  while (v.norm() > 1.0 || v.norm() < 0.1) v = random.vector<3>(-1.0, 1.0);
  return v.normalized();
}

/// Returns the cost that the solver minimises: position error over the arm's length and angle error in rad,
/// combined. It defines the nearest pose to an unreachable target.
inline double miss_of(const Arm& arm, const TipTarget& target, const ArmState& state) {
  const Pose X_WT = tip_pose(arm, state);
  const double position = (X_WT.position - target.position).norm() / arm.length();
  if (!target.direction) return position;
  const Eigen::Vector3d z = X_WT.rotation.col(2);
  const Eigen::Vector3d d = target.direction->normalized();
  return std::hypot(position, std::atan2(z.cross(d).norm(), z.dot(d)));
}

/// Returns the tolerance for "nearer than the answer", as a share of the answer's own distance. It is larger
/// for directions, because their minima are long and flat and the search stops slightly before the bottom.
inline double nearer_by(const TipTarget& target) { return target.direction ? 1e-4 : 1e-6; }

/// Returns the minimum of `measure` found by random descent from `state` within the bend limits. Steps get
/// shorter after failures and longer after successes; no derivatives are used.
template <class Measure>
double random_descent(TestRandom& random, const Arm& arm, ArmState state, int tries, const Measure& measure) {
  double best = measure(state);
  double step = 0.3;
  for (int i = 0; i < tries; ++i) {
    ArmState other = state;
    for (std::size_t k = 0; k < arm.sections.size(); ++k) {
      other.bends[k] += step * random.vector<2>(-1.0, 1.0);
      if (arm.kind == ArmKind::planar) other.bends[k].y() = 0.0;
      other.bends[k] *= std::min(1.0, arm.sections[k].max_bend / other.bends[k].norm());
    }
    const double found = measure(other);
    step = found < best ? std::min(1.0, 1.3 * step) : 0.93 * step;
    if (found < best) best = found, state = std::move(other);
  }
  return best;
}

/// Returns a target that an arm of random_three_sections provably cannot reach, without using the code under
/// test. `way` 0: beyond the arm's length. 1: behind the base, where an arm that turns by at most a quarter
/// has no tip. 2: so near to the base that even the fully bent arm has its tip farther away. 3: pointing
/// further round than all bends together. Sets the limits of `arm` as needed. `at_least` receives a lower
/// bound of the position error, m (0 for `way` 3).
inline TipTarget unreachable_target(TestRandom& random, int way, Arm& arm, double& at_least) {
  using std::numbers::pi;
  TipTarget target;
  at_least = 0.0;
  if (way == 0) {
    at_least = arm.length() * std::pow(10.0, random.uniform(-4.0, 2.0));
    target.position = (arm.length() + at_least) * random_unit(random);
  } else if (way == 1) {
    for (Section& section : arm.sections) section.max_bend = random.uniform(0.1, 0.5 * pi / 3.0);
    at_least = random.uniform(1e-3, 1.0);
    target.position = random.uniform(0.0, 0.5) * random_unit(random);
    target.position.y() = -at_least;
  } else if (way == 2) {
    // A curve of length L with a total turn below b has a chord longer than L cos(b/2).
    double turn = 0.0;
    for (Section& section : arm.sections) turn += section.max_bend = random.uniform(0.1, 0.9 * pi / 3.0);
    const double hole = arm.length() * std::cos(0.5 * turn);
    const double radius = random.uniform(0.0, 0.999) * hole;
    at_least = hole - radius;
    target.position = radius * random_unit(random);
  } else {
    double turn = 0.0;
    for (Section& section : arm.sections) turn += section.max_bend = random.uniform(0.1, 0.9 * pi / 3.0);
    target.position = tip_pose(arm, random_state_within(random, arm)).position;
    const double angle = random.uniform(turn + 1e-3, pi);
    const double around = random.uniform(-pi, pi);
    // The base's z is the world's Y.
    target.direction = Eigen::Vector3d(std::sin(angle) * std::cos(around), std::cos(angle),
                                       std::sin(angle) * std::sin(around));
  }
  return target;
}

}  // namespace flexura
