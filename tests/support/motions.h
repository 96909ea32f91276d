#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "flexura/kinematics/cord_motion.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/motion.h"
#include "flexura/kinematics/shape.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/model/arm.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// A horizon longer than any motion of a test, s.
inline constexpr double forever = 1e9;

/// Returns random bends up to 3 rad in each direction (planar arms: in the plane) and stretches from 0.8 to
/// 1.2.
inline ArmState random_keyframe(TestRandom& random, const Arm& arm) {
  ArmState state = ArmState::straight(arm.sections.size());
  for (Eigen::Vector2d& bend : state.bends) {
    bend = random.vector<2>(-3, 3);
    if (arm.kind == ArmKind::planar) bend.y() = 0;
  }
  for (double& stretch : state.stretches) stretch = random.uniform(0.8, 1.2);
  return state;
}

/// Returns a move in cord angles with a law for each section, and a swing of cord angles. In these laws the
/// bend of a section depends on all cords before it. Planar arms only.
inline std::vector<MotionPtr> random_cord_motions(TestRandom& random, const Arm& arm) {
  const double duration = random.uniform(0.2, 5);
  const ArmState from = random_keyframe(random, arm);
  const ArmState to = random_keyframe(random, arm);
  std::vector<double> changes = cord_angles(arm, to);
  const std::vector<double> first = cord_angles(arm, from);
  std::vector<Profile> profiles;
  std::vector<double> amplitudes;
  std::vector<double> phases;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    changes[i] -= first[i];
    profiles.push_back(random.integer(0, 1) == 0 ? Profile::linear(duration)
                                                 : Profile::minimum_jerk(duration));
    amplitudes.push_back(random.uniform(-0.7, 0.7));
    phases.push_back(random.uniform(-4, 4));
  }
  return {cord_point_to_point_motion(from, to, changes, profiles),
          cord_sine_motion(from, amplitudes, phases, random.uniform(0.2, 3), duration)};
}

/// Returns the fastest trapezoid between two states within a rate and an acceleration limit of each section.
inline MotionPtr random_trapezoids(TestRandom& random, const Arm& arm) {
  const ArmState from = random_keyframe(random, arm);
  const ArmState to = random_keyframe(random, arm);
  double rate = 1e3;
  double acceleration = 1e3;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const double way =
        std::max((to.bends[i] - from.bends[i]).norm(), std::abs(to.stretches[i] - from.stretches[i]));
    rate = std::min(rate, random.uniform(0.5, 10) / way);
    acceleration = std::min(acceleration, random.uniform(0.5, 30) / way);
  }
  return point_to_point_motion(
      from, to, std::vector<Profile>(arm.sections.size(), Profile::trapezoid(1, rate, acceleration)));
}

/// Returns a move to a tip position, with the state found by inverse kinematics.
inline MotionPtr random_move_of_tip(TestRandom& random, const Arm& arm) {
  const ArmState from = random_keyframe(random, arm);
  const Eigen::Vector3d place = tip_pose(arm, random_keyframe(random, arm)).position;
  const InverseResult there = solve_inverse(arm, {.position = place}, {.start = from, .max_starts = 4});
  const std::vector<Profile> profiles(arm.sections.size(), Profile::minimum_jerk(random.uniform(0.2, 5)));
  return point_to_point_motion(from, there.state, profiles);
}

/// Returns one motion of every kind with known rates: hold, point to point (linear with minimum jerk,
/// trapezoid), sine, keyframes linear and smooth, trapezoids by limits of each section, and a move of the
/// tip. A planar arm also gets a move and a swing of its cords.
inline std::vector<MotionPtr> random_motions(TestRandom& random, const Arm& arm) {
  const std::size_t n = arm.sections.size();
  const auto state = [&] { return random_keyframe(random, arm); };
  const double duration = random.uniform(0.2, 5);
  std::vector<Profile> profiles(n, Profile::linear(duration));
  profiles.back() = Profile::minimum_jerk(duration);
  const std::vector<Profile> trapezoids(
      n, Profile::trapezoid(random.uniform(0.1, 6), random.uniform(0.5, 10), random.uniform(0.5, 30)));
  std::vector<Eigen::Vector2d> amplitudes;
  std::vector<double> phases;
  for (std::size_t i = 0; i < n; ++i) {
    amplitudes.emplace_back(random.vector<2>(-1, 1));
    if (arm.kind == ArmKind::planar) amplitudes.back().y() = 0;
    phases.push_back(random.uniform(-4, 4));
  }
  std::vector<double> times{0};
  std::vector<ArmState> states{state()};
  for (int k = random.integer(1, 6); k > 0; --k) {
    times.push_back(times.back() + random.uniform(0.05, 2));
    states.push_back(state());
  }
  std::vector<MotionPtr> motions{hold_motion(state(), duration),
                                 point_to_point_motion(state(), state(), profiles),
                                 point_to_point_motion(state(), state(), trapezoids),
                                 sine_motion(state(), amplitudes, phases, random.uniform(0.2, 3), duration),
                                 keyframe_motion(times, states, Interpolation::linear),
                                 keyframe_motion(times, states, Interpolation::smooth),
                                 random_trapezoids(random, arm),
                                 random_move_of_tip(random, arm)};
  if (arm.kind == ArmKind::spatial) return motions;
  for (MotionPtr& motion : random_cord_motions(random, arm)) motions.push_back(std::move(motion));
  return motions;
}

}  // namespace flexura
