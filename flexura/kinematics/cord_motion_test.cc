#include "flexura/kinematics/cord_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "flexura/kinematics/shape.h"
#include "tests/support/arms.h"
#include "tests/support/motions.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

Arm random_cord_arm(TestRandom& random) {
  Arm arm = random_arm(random);
  arm.kind = ArmKind::planar;
  return arm;
}

// Returns profiles of one duration, all kinds in turn.
std::vector<Profile> mixed_profiles(TestRandom& random, std::size_t count) {
  const double duration = random.uniform(0.2, 5);
  std::vector<Profile> profiles;
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_linear = random.integer(0, 1) == 0;
    profiles.push_back(is_linear ? Profile::linear(duration) : Profile::minimum_jerk(duration));
  }
  return profiles;
}

MotionPtr cord_move(const Arm& arm, const ArmState& from, const ArmState& to,
                    const std::vector<Profile>& profiles) {
  const auto first = cord_angles(arm, from);
  auto changes = cord_angles(arm, to);
  for (std::size_t i = 0; i < changes.size(); ++i) changes[i] -= first[i];
  return cord_point_to_point_motion(from, to, changes, profiles);
}

TEST(CordMotion, EveryCordFollowsItsOwnLaw) {
  for_random_cases(100, [](TestRandom& random) {
    const Arm arm = random_cord_arm(random);
    const ArmState from = random_keyframe(random, arm);
    const ArmState to = random_keyframe(random, arm);
    const auto profiles = mixed_profiles(random, arm.sections.size());
    const MotionPtr motion = cord_move(arm, from, to, profiles);
    const double t = random.uniform(0, motion->duration());
    const ArmState state = motion->at(t);
    const auto cords = cord_angles(arm, state);
    const auto first = cord_angles(arm, from);
    const auto last = cord_angles(arm, to);
    for (std::size_t i = 0; i < cords.size(); ++i) {
      const double done = profiles[i].fraction(t);
      EXPECT_NEAR(cords[i], (1 - done) * first[i] + done * last[i], 1e-12) << i;
      EXPECT_NEAR(state.stretches[i], (1 - done) * from.stretches[i] + done * to.stretches[i], 1e-14);
    }
    EXPECT_EQ(motion->at(0).bends, from.bends);
    EXPECT_EQ(motion->at(motion->duration()).bends, to.bends);
    // Continuous at the end, where the state is the given one.
    const ArmState before = motion->at(motion->duration() * (1 - 1e-13));
    for (std::size_t i = 0; i < cords.size(); ++i) EXPECT_NEAR(before.bends[i].x(), to.bends[i].x(), 1e-9);
  });
}

TEST(CordMotion, EveryCordSwingsWithItsOwnPhase) {
  for_random_cases(100, [](TestRandom& random) {
    const Arm arm = random_cord_arm(random);
    const ArmState from = random_keyframe(random, arm);
    std::vector<double> amplitudes;
    std::vector<double> phases;
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      amplitudes.push_back(random.uniform(-1, 1));
      phases.push_back(random.uniform(-4, 4));
    }
    const double period = random.uniform(0.2, 3);
    const MotionPtr motion = cord_sine_motion(from, amplitudes, phases, period, 5.0);
    const double t = random.uniform(0, 5);
    const auto cords = cord_angles(arm, motion->at(t));
    const auto first = cord_angles(arm, from);
    for (std::size_t i = 0; i < cords.size(); ++i) {
      const double swing = std::sin(2 * std::numbers::pi * t / period + phases[i]) - std::sin(phases[i]);
      EXPECT_NEAR(cords[i], first[i] + amplitudes[i] * swing, 1e-12) << i;
    }
  });
}

TEST(CordMotion, NeverGoesFasterThanItsRatesSayAndTheyComeDownToTheRate) {
  for_random_cases(60, [](TestRandom& random) {
    const Arm arm = random_cord_arm(random);
    const MotionPtr motion = cord_move(arm, random_keyframe(random, arm), random_keyframe(random, arm),
                                       mixed_profiles(random, arm.sections.size()));
    const double start = random.uniform(0, motion->duration());
    const double end = random.uniform(start, motion->duration());
    constexpr int steps = 500;
    const double h = (end - start) / steps;
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      const SectionRates bound = motion->rates(i, start, end).value();
      for (int k = 0; k < steps; ++k) {
        const ArmState a = motion->at(start + k * h);
        const ArmState b = motion->at(start + (k + 1) * h);
        EXPECT_LE((b.bends[i] - a.bends[i]).norm(), bound.bend * h + 1e-12);
        EXPECT_LE(std::abs(b.stretches[i] - a.stretches[i]), bound.stretch * h + 1e-12);
      }
      const double dt = 1e-5 * motion->duration();
      const double t = random.uniform(dt, motion->duration() - dt);
      const double rate = (motion->at(t + dt).bends[i].x() - motion->at(t - dt).bends[i].x()) / (2 * dt);
      EXPECT_NEAR(motion->rates(i, t, t)->bend, std::abs(rate),
                  1e-4 * (1 + std::abs(rate)) / motion->duration());
    }
  });
}

TEST(CordMotion, RefusesWhatDoesNotFitTheArm) {
  const ArmState two = ArmState::straight(2);
  const std::vector<Profile> profiles(2, Profile::linear(1));
  EXPECT_THROW((void)cord_point_to_point_motion(two, two, {0}, profiles), std::invalid_argument);
  EXPECT_THROW((void)cord_point_to_point_motion(two, two, {0, 0}, {Profile::linear(1)}),
               std::invalid_argument);
  EXPECT_THROW((void)cord_point_to_point_motion(two, two, {0, 0}, {Profile::linear(1), Profile::linear(2)}),
               std::invalid_argument);
  EXPECT_THROW((void)cord_sine_motion(two, {0.1}, {0, 0}, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
