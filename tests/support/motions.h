#pragma once

#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// A horizon that no motion of a test reaches, s.
inline constexpr double forever = 1e9;

/// Bends up to 3 rad in each direction (planar arms: in the plane), stretches from 0.8 to 1.2.
inline ArmState random_keyframe(TestRandom& random, const Arm& arm) {
  ArmState state = ArmState::straight(arm.sections.size());
  for (Eigen::Vector2d& bend : state.bends) {
    bend = random.vector<2>(-3, 3);
    if (arm.kind == ArmKind::planar) bend.y() = 0;
  }
  for (double& stretch : state.stretches) stretch = random.uniform(0.8, 1.2);
  return state;
}

/// One motion of every kind that knows its rates: hold, point to point (linear with minimum jerk, trapezoid),
/// sine, keyframes linear and smooth.
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
  return {hold_motion(state(), duration),
          point_to_point_motion(state(), state(), profiles),
          point_to_point_motion(state(), state(), trapezoids),
          sine_motion(state(), amplitudes, phases, random.uniform(0.2, 3), duration),
          keyframe_motion(times, states, Interpolation::linear),
          keyframe_motion(times, states, Interpolation::smooth)};
}

}  // namespace flexura
