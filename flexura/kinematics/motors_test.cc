#include "flexura/kinematics/motors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/kinematics/tendons.h"
#include "tests/support/arms.h"
#include "tests/support/drives.h"

namespace flexura {
namespace {

std::vector<double> reals(const std::vector<std::int64_t>& positions) {
  return {positions.begin(), positions.end()};
}

// 300 * 10 microsteps per turn, gear 10, spool of 10 mm: 30000 microsteps for 62.8 mm of cable.
Drive one_axis(double backlash = 0) {
  Drive drive;
  drive.tendons = {{}};
  drive.axes = {
      {.motor = {}, .spool = {.radius = 0.01, .gear = 10, .backlash = backlash}, .reversed = false}};
  return drive;
}

constexpr double one_turn = 2 * std::numbers::pi * 0.01;  // In m of cable.

TEST(Motors, CountSpoolTurnsThroughTheGear) {
  Drive drive = one_axis();
  EXPECT_DOUBLE_EQ(motor_positions(drive, {{one_turn / 4}})[0], 7500);
  EXPECT_DOUBLE_EQ(drive.axes[0].microsteps_a_metre(), 30000 / one_turn);
  drive.axes[0].reversed = true;
  EXPECT_DOUBLE_EQ(motor_positions(drive, {{one_turn / 4}})[0], -7500);
  EXPECT_DOUBLE_EQ(displacements_at(drive, std::vector{-7500.0}).pulled[0], one_turn / 4);
}

TEST(Motors, LimitsBoundTheCable) {
  Axis axis = one_axis().axes[0];
  EXPECT_EQ(axis.max_cable_speed(), std::numeric_limits<double>::infinity());
  axis.motor.max_speed = 4 * std::numbers::pi;  // Two turns per second, a fifth of a turn of the spool.
  EXPECT_DOUBLE_EQ(axis.max_cable_speed(), one_turn / 5);
  axis.motor.max_step_rate = 3000;  // One turn per second.
  EXPECT_DOUBLE_EQ(axis.max_cable_speed(), one_turn / 10);
}

TEST(Motors, RoundTripsToHalfAMicrostepOverRandomArms) {
  for_random_cases(300, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const Drive drive = random_scanty_drive(random, arm);
    const ArmState state = random_state(random, arm);
    ArmState inextensible = state;
    std::ranges::fill(inextensible.stretches, 1.0);
    const TendonDisplacements desired = tendon_displacements(arm, drive, inextensible);
    const MotorCommander commander(drive, desired);
    const std::vector<double> positions = reals(commander.positions());

    const TendonFit fit = fit_state(arm, drive, displacements_at(drive, positions));
    const TendonDisplacements found = tendon_displacements(arm, drive, fit.state);
    const std::vector<double> back = motor_positions(drive, found);
    const std::vector<double> exact = motor_positions(drive, desired);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      EXPECT_LE(std::abs(positions[i] - exact[i]), 0.5 + 1e-6);
      EXPECT_NEAR(back[i], positions[i], 1e-6);
      EXPECT_LE(std::abs(found.pulled[i] - desired.pulled[i]) * drive.axes[i].microsteps_a_metre(),
                0.5 + 2e-6);
    }
    EXPECT_EQ(MotorCommander(drive, found).positions(), commander.positions());
  });
}

// Tendons of a section at `angles`, on motors with 30000 microsteps per turn of a 10 mm spool.
Drive drive_at(const std::vector<double>& angles, std::size_t sections) {
  Drive drive;
  for (std::size_t section = 0; section < sections; ++section) {
    for (const double angle : angles) {
      drive.tendons.push_back({section, 0.02, angle + 0.3 * static_cast<double>(section)});
      drive.axes.push_back({.motor = {}, .spool = {.radius = 0.01, .gear = 10}, .reversed = angle > 3});
    }
  }
  return drive;
}

// Returns the pseudo-inverse of the map from a sum of bends to the tendons of a section, by the normal
// equations.
Eigen::MatrixXd bends_of_cables(const Drive& drive, std::size_t section) {
  Eigen::MatrixXd offsets(0, 2);
  for (const Tendon& tendon : drive.tendons) {
    if (tendon.section != section) continue;
    offsets.conservativeResize(offsets.rows() + 1, 2);
    offsets.bottomRows(1) = tendon.offset().transpose();
  }
  return (offsets.transpose() * offsets).inverse() * offsets.transpose();
}

// Bends to cables, spools, whole microsteps and back, with as many tendons as real arms have. The result must
// be the least-squares fit to the rounded cables, computed here without the code under test. It must be no
// further from the bends than all roundings together can move it.
TEST(Motors, RoundTripWithThreeFourOrFiveTendonsEvenAndUneven) {
  const double turn = 2 * std::numbers::pi;
  const std::vector<std::vector<double>> placements{{0, turn / 3, 2 * turn / 3},
                                                    {0, turn / 4, turn / 2, 3 * turn / 4},
                                                    {0, turn / 5, 2 * turn / 5, 3 * turn / 5, 4 * turn / 5},
                                                    {0, 0.4, 1.1, 3.5},
                                                    {0.1, 0.2, 2.0, 2.1, 4.4}};
  for (const auto& angles : placements) {
    SCOPED_TRACE(std::to_string(angles.size()) + " tendons, the second at " + std::to_string(angles[1]));
    for_random_cases(100, [&](TestRandom& random) {
      Arm arm;
      arm.kind = ArmKind::spatial;
      arm.sections.resize(static_cast<std::size_t>(random.integer(1, 3)));
      const Drive drive = drive_at(angles, arm.sections.size());
      ArmState state = ArmState::straight(arm.sections.size());
      for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-2, 2);
      const MotorCommander commander(drive, tendon_displacements(arm, drive, state));
      const TendonDisplacements rounded = displacements_at(drive, reals(commander.positions()));
      const TendonFit fit = fit_state(arm, drive, rounded);
      const double half_step = 0.5 / drive.axes[0].microsteps_a_metre();
      Eigen::Vector2d desired = Eigen::Vector2d::Zero();
      Eigen::Vector2d found = Eigen::Vector2d::Zero();
      for (std::size_t k = 0; k < arm.sections.size(); ++k) {
        desired += state.bends[k];
        found += fit.state.bends[k];
        const Eigen::MatrixXd inverse = bends_of_cables(drive, k);
        Eigen::VectorXd cables(inverse.cols());
        for (Eigen::Index i = 0; i < cables.size(); ++i)
          cables[i] = rounded.pulled[k * angles.size() + static_cast<std::size_t>(i)];
        EXPECT_LT((found - inverse * cables).norm(), 1e-9);
        const double most = inverse.colwise().norm().sum() * half_step;
        EXPECT_LE((found - desired).norm(), most * (1 + 1e-6) + 1e-9);
      }
    });
  }
}

TEST(Motors, WithPlayTakenUpFollowToHalfAMicrostepWhateverTheWay) {
  for_random_cases(100, [](TestRandom& random) {
    Arm arm = random_arm(random);
    const Drive drive = random_drive(random, arm);
    TendonDisplacements desired{std::vector<double>(drive.axes.size(), 0.0)};
    MotorCommander commander(drive, desired);
    BacklashModel mechanism(drive, commander.positions());
    for (int step = 0; step < 300; ++step) {
      for (std::size_t i = 0; i < drive.axes.size(); ++i) {
        // Steps of hundreds of microsteps and of fractions of one, in either direction, and rests.
        const double size = std::pow(10.0, random.integer(-2, 3)) * random.integer(0, 1);
        desired.pulled[i] += random.uniform(-size, size) / drive.axes[i].microsteps_a_metre();
      }
      commander.follow(desired);
      mechanism.follow(commander.positions());
      const TendonDisplacements made = mechanism.displacements();
      for (std::size_t i = 0; i < drive.axes.size(); ++i) {
        EXPECT_LE(std::abs(made.pulled[i] - desired.pulled[i]) * drive.axes[i].microsteps_a_metre(),
                  0.5 + 3e-6)
            << "step " << step << ", axis " << i;
      }
    }
  });
}

TEST(Motors, TakeUpThePlayWhenATendonReverses) {
  const double backlash = 100.25;  // Microsteps.
  const Drive drive = one_axis(backlash / 30000 * 2 * std::numbers::pi);
  const double microstep = one_turn / 30000;
  EXPECT_NEAR(drive.axes[0].backlash_steps(), backlash, 1e-12);
  MotorCommander commander(drive, {{0}});
  const auto positions_at = [&](double microsteps) {
    commander.follow({{microsteps * microstep}});
    return commander.positions()[0];
  };
  EXPECT_EQ(positions_at(50), 50);
  EXPECT_EQ(positions_at(49), -51) << "49 - 100.25, and no sooner";
  EXPECT_EQ(positions_at(-20), -120);
  EXPECT_EQ(positions_at(-20), -120);
  EXPECT_EQ(positions_at(-19), -19);
}

TEST(Motors, StayWhereTheyAreWhileTheArmHolds) {
  const Drive drive = one_axis(0.01);
  const double half_step = 0.5 * one_turn / 30000;
  MotorCommander commander(drive, {{-20 * half_step}});
  commander.follow({{-21 * half_step}});
  const std::vector<std::int64_t> before = commander.positions();
  // Rounding errors in the displacements are no movement, even where they decide between two steps.
  for (int i = 0; i < 10; ++i) {
    commander.follow({{-21 * half_step * (1 + (i % 3 - 1) * 1e-15)}});
    EXPECT_EQ(commander.positions(), before);
  }
}

TEST(Motors, RefuseWhatDoesNotFitOrCannotBeCounted) {
  const Drive drive = one_axis();
  EXPECT_THROW((void)motor_positions(drive, {{0, 0}}), std::invalid_argument);
  EXPECT_THROW((void)displacements_at(drive, std::vector{0.0, 1.0}), std::invalid_argument);
  MotorCommander commander(drive, {{0}});
  EXPECT_THROW(commander.follow({{0, 0}}), std::invalid_argument);
  EXPECT_THROW(commander.follow({{1e12}}), std::out_of_range);
  EXPECT_THROW(commander.follow({{std::nan("")}}), std::out_of_range);
}

TEST(Drive, NamesAxesByControllerAndAxis) {
  Drive drive;
  EXPECT_EQ(drive.axis_name(0), "1.1");
  EXPECT_EQ(drive.axis_name(4), "2.1");
  drive.axes_per_controller = 3;
  EXPECT_EQ(drive.axis_name(5), "2.3");
}

}  // namespace
}  // namespace flexura
