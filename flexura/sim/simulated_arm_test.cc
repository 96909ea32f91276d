#include "flexura/sim/simulated_arm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "flexura/kinematics/tendons.h"
#include "flexura/sim/simulated_clock.h"
#include "tests/support/motions.h"
#include "tests/support/random_cases.h"
#include "tests/support/rigs.h"

namespace flexura {
namespace {

ArmState random_shape(TestRandom& random) {
  ArmState state = ArmState::straight(2);
  for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-1, 1);
  return state;
}

double difference(const ArmState& a, const ArmState& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.bends.size(); ++i)
    largest = std::max(largest, (a.bends[i] - b.bends[i]).norm());
  return largest;
}

RigConfig without_drive() {
  RigConfig rig = two_section_rig();
  rig.drive.reset();
  return rig;
}

// The largest bend that half a microstep of every tendon makes.
double rounding(const RigConfig& rig) {
  const Drive drive = rig.drive->drive();
  double largest = 0;
  for (std::size_t i = 0; i < drive.axes.size(); ++i)
    largest = std::max(largest, 0.5 / (drive.axes[i].microsteps_a_metre() * drive.tendons[i].radius));
  return 4 * largest;
}

TEST(SimulatedArm, StartsInItsTrueInitialShape) {
  RigConfig model = two_section_rig(), truth = model;
  truth.arm.initial.bends = {{0.2, -0.1}, {0.3, 0.05}};
  SimulatedClock clock;
  SimulatedArm arm(ArmSetup{model}, ArmSetup{truth}, clock, forever);
  EXPECT_LE(difference(arm.truth(0), ArmSetup{truth}.initial), 1e-12);
  const ArmReading reading = arm.read().value();
  EXPECT_LE(difference(reading.state, ArmState::straight(2)), 1e-12);
  EXPECT_EQ(reading.positions, std::vector<std::int64_t>(6, 0));
  EXPECT_FALSE(reading.moving);
}

TEST(SimulatedArm, StartsBentWithItsMotorsWhereTheModelHasThem) {
  RigConfig rig = two_section_rig();
  rig.arm.initial.bends = {{0.4, -0.1}, {-0.3, 0.2}};
  SimulatedClock clock;
  SimulatedArm arm(ArmSetup{rig}, ArmSetup{rig}, clock, forever);
  EXPECT_LE(difference(arm.truth(0), ArmSetup{rig}.initial), 1e-12);
  const ArmReading reading = arm.read().value();
  EXPECT_LE(difference(reading.state, ArmSetup{rig}.initial), 1e-12);
  const ArmSetup setup(rig);
  EXPECT_EQ(reading.positions, nominal_positions(setup.arm, *setup.drive, setup.initial));
  EXPECT_GT(std::abs(reading.positions[0]), 100);
  ASSERT_TRUE(arm.command(ArmState::straight(2), 0));
  clock.wait_until(20);
  EXPECT_LE(difference(arm.truth(20), ArmState::straight(2)), rounding(rig));
}

TEST(SimulatedArm, GoesWhereItIsToldThroughPlayAndSteps) {
  for_random_cases(30, [](TestRandom& random) {
    const RigConfig rig = two_section_rig();
    SimulatedClock clock;
    SimulatedArm arm(ArmSetup{rig}, ArmSetup{rig}, clock, forever);
    for (int i = 0; i < 6; ++i) {
      const ArmState target = random_shape(random);
      ASSERT_TRUE(arm.command(target, 0));
      clock.wait_until(clock.now() + 10);
      EXPECT_LE(difference(arm.truth(clock.now()), target), rounding(rig));
      EXPECT_LE(difference(arm.read().value().state, target), rounding(rig));
      EXPECT_FALSE(arm.read().value().moving);
    }
  });
}

TEST(SimulatedArm, ItsMotorsObeyTheirSpeedAndAcceleration) {
  for_random_cases(6, [](TestRandom& random) {
    const RigConfig rig = two_section_rig();
    const Drive drive = rig.drive->drive();
    SimulatedClock clock;
    SimulatedArm arm(ArmSetup{rig}, ArmSetup{rig}, clock, forever);
    for (int i = 0; i < 8; ++i) {
      ASSERT_TRUE(arm.command(random_shape(random), 0));
      clock.wait_until(clock.now() + random.uniform(0, 0.5));
    }
    const ArmSetup setup(rig);
    constexpr double step = 2e-3;
    for (double t = step; t < clock.now() + 3; t += step) {
      const auto last = tendon_displacements(setup.arm, drive, arm.truth(t - step)).pulled;
      const auto now = tendon_displacements(setup.arm, drive, arm.truth(t)).pulled;
      for (std::size_t i = 0; i < now.size(); ++i)
        EXPECT_LE(std::abs(now[i] - last[i]), drive.axes[i].max_cable_speed() * step * (1 + 1e-6) + 1e-12);
    }
  });
}

TEST(SimulatedArm, TruePlayThatTheModelDoesNotKnowKeepsItAway) {
  RigConfig model = two_section_rig(), truth = model;
  model.drive->spool.backlash = 0;
  truth.drive->spool.backlash = 0.1;
  SimulatedClock clock;
  SimulatedArm arm(ArmSetup{model}, ArmSetup{truth}, clock, forever);
  ArmState bent = ArmState::straight(2);
  bent.bends[0] = {0.5, 0};
  ASSERT_TRUE(arm.command(bent, 0));
  clock.wait_until(20);
  ASSERT_TRUE(arm.command(ArmState::straight(2), 0));
  clock.wait_until(40);
  // 0.1 rad of a spool of 10 mm are 1 mm of cable at 15 mm from the backbone.
  EXPECT_GT(difference(arm.truth(40), ArmState::straight(2)), 0.02);
  EXPECT_LE(difference(arm.read().value().state, ArmState::straight(2)), rounding(model));
}

TEST(SimulatedArm, TrueTendonsBendItOtherwise) {
  RigConfig model = two_section_rig(), truth = model;
  truth.drive->radius = 0.0165;  // a tenth wider: a tenth less of bend
  SimulatedClock clock;
  SimulatedArm arm(ArmSetup{model}, ArmSetup{truth}, clock, forever);
  ArmState bent = ArmState::straight(2);
  bent.bends[0] = {0.5, 0};
  ASSERT_TRUE(arm.command(bent, 0));
  clock.wait_until(20);
  EXPECT_NEAR(arm.truth(20).bends[0].x(), 0.5 / 1.1, rounding(model));
  EXPECT_NEAR(arm.read().value().state.bends[0].x(), 0.5, rounding(model));
}

TEST(SimulatedArm, WithoutDrivesItsSectionsObeyTheirBendRates) {
  for_random_cases(20, [](TestRandom& random) {
    const RigConfig rig = without_drive();
    SimulatedClock clock;
    SimulatedArm arm(ArmSetup{rig}, ArmSetup{rig}, clock, forever);
    ArmState target;
    for (int i = 0; i < 8; ++i) {
      target = random_shape(random);
      ASSERT_TRUE(arm.command(target, 0));
      clock.wait_until(clock.now() + random.uniform(0, 3));
      const bool halts = random.integer(0, 4) == 0;
      ASSERT_TRUE(!halts || arm.halt());
    }
    ASSERT_TRUE(arm.command(target, 0));
    constexpr double step = 1e-3;
    for (double t = step; t < clock.now() + 7; t += step)
      EXPECT_LE(difference(arm.truth(t), arm.truth(t - step)), 0.5 * step * (1 + 1e-9));
    EXPECT_EQ(difference(arm.truth(clock.now() + 7), target), 0);
  });
}

TEST(SimulatedArm, WithoutDrivesKeepsToTheLimitsOfItsSections) {
  RigConfig rig = without_drive();
  rig.arm.section[0].max_bend = 0.6;
  SimulatedClock clock;
  SimulatedArm arm(ArmSetup{rig}, ArmSetup{rig}, clock, forever);
  ArmState target = ArmState::straight(2);
  target.bends[0] = {3, 4}, target.stretches[1] = 2;
  ASSERT_TRUE(arm.command(target, 0));
  EXPECT_TRUE(arm.read().value().moving);
  clock.wait_until(20);
  EXPECT_LE((arm.truth(20).bends[0] - Eigen::Vector2d(0.36, 0.48)).norm(), 1e-12);
  EXPECT_EQ(arm.truth(20).stretches[1], 1);
  EXPECT_FALSE(arm.read().value().moving);
}

// Commands that each last until the next one: the arm is where the motion is, between the commands too.
TEST(SimulatedArm, FollowsAMotionCommandByCommand) {
  const auto follow = [](const RigConfig& rig, double start, double tolerance) {
    const auto motion = [](double time) {
      ArmState state = ArmState::straight(2);
      state.bends[0].x() = 0.1 * time, state.bends[1].y() = -0.2 * time;
      return state;
    };
    SimulatedClock clock;
    SimulatedArm arm(ArmSetup{rig}, ArmSetup{rig}, clock, forever);
    constexpr double step = 0.02;
    for (double time = 0; time < 2; time += step) {
      clock.wait_until(time);
      ASSERT_TRUE(arm.command(motion(time + step), step));
    }
    for (double time = start; time < 2; time += 0.003)
      EXPECT_LE(difference(arm.truth(time), motion(time)), tolerance) << time;
  };
  follow(without_drive(), 0, 1e-12);
  RigConfig driven = two_section_rig();
  driven.drive->motor.max_acceleration = std::numeric_limits<double>::infinity();
  follow(driven, 0.2, 2 * rounding(driven));
  // A finite acceleration leaves it behind: by the way of the brake.
  driven.drive->motor.max_acceleration = 100;
  follow(driven, 0.2, 0.003);
}

TEST(SimulatedArm, RefusesShapesOfAnotherArm) {
  const auto refuses = [](const RigConfig& rig) {
    SimulatedClock clock;
    SimulatedArm arm(ArmSetup{rig}, ArmSetup{rig}, clock, forever);
    ArmState bad = ArmState::straight(2);
    bad.bends[1].x() = std::nan("");
    EXPECT_EQ(arm.command(bad, 0).fault()->kind, FaultKind::refused);
    EXPECT_EQ(arm.command(ArmState::straight(3), 0).fault()->kind, FaultKind::refused);
    bad = ArmState::straight(2);
    bad.stretches[0] = 0;
    EXPECT_EQ(arm.command(bad, 0).fault()->kind, FaultKind::refused);
    EXPECT_EQ(arm.command(ArmState::straight(2), -1).fault()->kind, FaultKind::refused);
    EXPECT_EQ(arm.command(ArmState::straight(2), std::nan("")).fault()->kind, FaultKind::refused);
    if (!rig.drive) return;
    bad = ArmState::straight(2);
    bad.bends[0].x() = 1e15;
    EXPECT_EQ(arm.command(bad, 0).fault()->kind, FaultKind::refused);
  };
  refuses(two_section_rig());
  refuses(without_drive());
}

}  // namespace
}  // namespace flexura
