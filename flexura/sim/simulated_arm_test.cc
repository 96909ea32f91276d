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

// Returns the largest bend caused by half a microstep of every tendon.
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
  // 0.1 rad of a spool of 10 mm radius are 1 mm of cable, at 15 mm from the backbone.
  EXPECT_GT(difference(arm.truth(40), ArmState::straight(2)), 0.02);
  EXPECT_LE(difference(arm.read().value().state, ArmState::straight(2)), rounding(model));
}

// Random shapes one after the other. The true tendons lose travel by friction, as the model knows.
TEST(SimulatedArm, FrictionThatTheModelKnowsIsCompensated) {
  RigConfig rig = two_section_rig();
  rig.drive->spool.friction_travel = 0.001;
  RigConfig unknowing = rig;
  unknowing.drive->spool.friction_travel.reset();
  for_random_cases(5, [&](TestRandom& random) {
    SimulatedClock clock;
    SimulatedArm arm(ArmSetup{rig}, ArmSetup{rig}, clock, 0.5),
        without(ArmSetup{unknowing}, ArmSetup{rig}, clock, 0.5);
    ArmState target = ArmState::straight(2);
    double worst = 0, worst_without = 0;
    for (int motion = 0; motion < 6; ++motion) {
      const ArmState from = target;
      for (Eigen::Vector2d& bend : target.bends) bend = random.vector<2>(-1, 1);
      const double start = clock.now();
      for (int step = 1; step <= 100; ++step) {
        ArmState now = from;
        for (std::size_t k = 0; k < 2; ++k) now.bends[k] += 0.01 * step * (target.bends[k] - from.bends[k]);
        for (SimulatedArm* each : {&arm, &without}) ASSERT_TRUE(each->command(now, 0.1));
        clock.wait_until(start + 0.1 * step);
        for (SimulatedArm* each : {&arm, &without}) each->plant().advance(clock.now());
      }
      clock.wait_until(clock.now() + 5);
      for (SimulatedArm* each : {&arm, &without}) each->plant().advance(clock.now());
      worst = std::max(worst, difference(arm.truth(clock.now()), target));
      worst_without = std::max(worst_without, difference(without.truth(clock.now()), target));
      EXPECT_LE(difference(arm.read().value().state, target), 3 * rounding(rig));
      EXPECT_LE(difference(arm.truth(clock.now() + 100), target), 3 * rounding(rig)) << "at rest";
    }
    EXPECT_LE(worst, 3 * rounding(rig));
    EXPECT_GT(worst_without, 0.02) << "half a millimetre per radian, at 15 mm from the backbone";
  });
}

// Answers about tendons with friction do not depend on earlier queries.
TEST(SimulatedArm, WithFrictionAnswersTheSameHoweverItIsAsked) {
  RigConfig rig = two_section_rig();
  rig.drive->spool.friction_travel = 0.002;
  SimulatedClock clock;
  SimulatedArm asked(ArmSetup{rig}, ArmSetup{rig}, clock, 1), silent(ArmSetup{rig}, ArmSetup{rig}, clock, 1);
  for (int i = 0; i < 60; ++i) {
    ArmState target = ArmState::straight(2);
    target.bends[1] = {0.3 * std::sin(0.7 * i), 0.2 * i / 60};
    for (SimulatedArm* each : {&asked, &silent}) ASSERT_TRUE(each->command(target, 0.1));
    clock.wait_until(clock.now() + 0.093);
    for (int k = 0; k < 3; ++k) (void)asked.truth(clock.now() - 0.013 * k);
    asked.plant().advance(clock.now());
  }
  const double now = clock.now();
  silent.plant().advance(now);
  for (const double time : {now - 0.9, now - 0.333, now, now + 1})
    EXPECT_EQ(difference(asked.truth(time), silent.truth(time)), 0) << now - time;
}

TEST(SimulatedArm, TrueTendonsBendItOtherwise) {
  RigConfig model = two_section_rig(), truth = model;
  truth.drive->radius = 0.0165;  // A tenth wider: a tenth less bend.
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

// Each command lasts until the next one: the arm follows the motion, also between the commands.
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
  // With finite acceleration the arm lags by the braking distance.
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
