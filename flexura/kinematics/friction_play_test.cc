#include "flexura/kinematics/friction_play.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "flexura/kinematics/motors.h"
#include "flexura/kinematics/tendons.h"
#include "tests/support/arms.h"
#include "tests/support/drives.h"

namespace flexura {
namespace {

// 300 * 10 microsteps per turn, gear 10, spool of 10 mm: 30000 microsteps for 62.8 mm of cable.
Drive rubbing_axis(double travel, double backlash = 0) {
  Drive drive;
  drive.tendons = {{}};
  drive.axes = {
      {.motor = {}, .spool = {.radius = 0.01, .gear = 10, .backlash = backlash, .friction_travel = travel}}};
  return drive;
}

// Adds a lost travel of up to a quarter of its radius to each tendon.
Drive rubbing_drive(TestRandom& random, const Arm& arm) {
  Drive drive = random_drive(random, arm);
  for (std::size_t i = 0; i < drive.axes.size(); ++i)
    drive.axes[i].spool.friction_travel = random.uniform(0, 0.25) * drive.tendons[i].radius;
  return drive;
}

ArmState random_bends(TestRandom& random, const Arm& arm) {
  ArmState state = ArmState::straight(arm.sections.size());
  for (Eigen::Vector2d& bend : state.bends) {
    bend = random.vector<2>(-1.5, 1.5);
    if (arm.kind == ArmKind::planar) bend.y() = 0;
  }
  return state;
}

double largest_bend_error(const ArmState& a, const ArmState& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.bends.size(); ++i)
    largest = std::max(largest, (a.bends[i] - b.bends[i]).norm());
  return largest;
}

// Sum of a function's values at the midpoints of 10^5 equal pieces of [0, end], times their length.
template <class Function>
double integral(double end, const Function& function) {
  constexpr int pieces = 100000;
  double sum = 0;
  for (int i = 0; i < pieces; ++i) sum += function((i + 0.5) * end / pieces);
  return sum * end / pieces;
}

// The tension along the wrap is that of a capstan (L. Euler, J. Eytelwein), and the arm keeps its shape if
// the mean tension stays the same. The travel is the change of the stretch outside the arm.
TEST(FrictionTravel, IsThatOfATendonOnACapstan) {
  for_random_cases(20, [](TestRandom& random) {
    const double mu = random.uniform(0.01, 0.6), wrap = random.uniform(0.1, 4), mean = random.uniform(1, 50),
                 compliance = random.uniform(1e-5, 1e-3);
    const auto base_tension = [&](double side) {
      return mean * wrap / integral(wrap, [&](double angle) { return std::exp(-side * mu * angle); });
    };
    const double stretch = compliance * (base_tension(1) - base_tension(-1));
    const Drive drive = rubbing_axis(compliance * mu * mean);
    EXPECT_NEAR(drive.axes[0].friction_steps(wrap) / drive.axes[0].microsteps_a_metre(), stretch,
                1e-7 * stretch);
  });
}

TEST(FrictionTravel, GrowsWithTheBendsThatATendonPasses) {
  for_random_cases(50, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const Drive drive = rubbing_drive(random, arm);
    const ArmState state = random_bends(random, arm);
    const TendonDisplacements displacements = tendon_displacements(arm, drive, state);
    for (std::size_t i = 0; i < drive.tendons.size(); ++i) {
      double passed = 0;
      for (std::size_t k = 0; k <= drive.tendons[i].section; ++k) passed += state.bends[k].norm();
      EXPECT_NEAR(displacements.wraps[i], passed, 1e-12);
    }
    Drive smooth = drive;
    for (Axis& axis : smooth.axes) axis.spool.friction_travel.reset();
    EXPECT_TRUE(tendon_displacements(arm, smooth, state).wraps.empty());
    EXPECT_EQ(tendon_displacements(arm, smooth, state).pulled, displacements.pulled);
  });
}

TEST(MotorsWithFriction, MoveHalfOfTheLostTravelFurtherInEitherDirection) {
  const double microstep = 2 * std::numbers::pi * 0.01 / 30000;
  const double backlash = 10.25;  // Microsteps.
  const Drive drive = rubbing_axis(100 * microstep, backlash / 30000 * 2 * std::numbers::pi);
  MotorCommander commander(drive, {{0}, {0}});
  const auto position_at = [&](double microsteps, double wrap) {
    commander.follow({{microsteps * microstep}, {wrap}});
    return commander.positions()[0];
  };
  EXPECT_EQ(position_at(50, 0.5), 75) << "50 and half of 50";
  EXPECT_EQ(commander.taken_up()[0], 0);
  EXPECT_EQ(position_at(40, 0.5), 5) << "40 - 25 - 10.25";
  EXPECT_NEAR(commander.taken_up()[0], 60.25, 1e-9);
  EXPECT_EQ(position_at(40, 1), -20) << "40 - 50 - 10.25";
  // The tendon rests, and its spool pulls in because the tendon turns by less.
  EXPECT_EQ(position_at(40, 0.5), 15) << "40 - 25";
  EXPECT_NEAR(commander.taken_up()[0], backlash, 1e-9);
  EXPECT_EQ(position_at(41, 0.5), 66) << "41 + 25";
  EXPECT_THROW(commander.follow({{0}, {0, 0}}), std::invalid_argument);
}

// Motors that are commanded like this, spools with backlash, and tendons with friction give the shapes.
TEST(MotorsWithFriction, GiveTheShapesThatAreCommanded) {
  for_random_cases(60, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const Drive drive = rubbing_drive(random, arm);
    ArmState state = ArmState::straight(arm.sections.size());
    MotorCommander commander(drive, tendon_displacements(arm, drive, state));
    BacklashModel spools(drive, commander.positions());
    FrictionPlay tendons(arm, drive, state);
    // What half a microstep of each tendon bends, rad.
    double rounding = 0;
    for (std::size_t i = 0; i < drive.axes.size(); ++i)
      rounding += 4 / (drive.axes[i].microsteps_a_metre() * drive.tendons[i].radius);
    for (int target = 0; target < 6; ++target) {
      const ArmState from = state, to = random_bends(random, arm);
      for (int step = 1; step <= 10; ++step) {
        for (std::size_t k = 0; k < state.bends.size(); ++k)
          state.bends[k] = from.bends[k] + 0.1 * step * (to.bends[k] - from.bends[k]);
        commander.follow(tendon_displacements(arm, drive, state));
        spools.follow(commander.positions());
        ASSERT_LE(largest_bend_error(tendons.follow(spools.displacements().pulled), state), rounding)
            << "target " << target << ", step " << step;
      }
    }
  });
}

// After each motion, every tendon is within half of its lost travel from its spool, for the wraps of the new
// shape; and it has moved only if it is at the edge.
TEST(FrictionPlay, MovesTendonsNoFurtherThanTheirSpoolsForceThemTo) {
  for_random_cases(60, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const Drive drive = rubbing_drive(random, arm);
    FrictionPlay play(arm, drive, random_bends(random, arm));
    for (int motion = 0; motion < 10; ++motion) {
      const std::vector<double> before_wraps = tendon_wraps(arm, drive, play.state());
      std::vector<double> before = play.spools(), spools = before;
      for (std::size_t i = 0; i < spools.size(); ++i) {
        before[i] -= *drive.axes[i].spool.friction_travel * before_wraps[i] / 2;
        spools[i] += random.uniform(-0.3, 0.3) * drive.tendons[i].radius;
      }
      const ArmState& state = play.follow(spools);
      const std::vector<double> wraps = tendon_wraps(arm, drive, state), ends = play.spools();
      TendonDisplacements tendons;
      for (std::size_t i = 0; i < spools.size(); ++i) {
        const double half = *drive.axes[i].spool.friction_travel * wraps[i] / 2, tendon = ends[i] - half;
        EXPECT_LE(std::abs(tendon - spools[i]), half + 1e-12);
        const bool is_at_edge = std::abs(std::abs(tendon - spools[i]) - half) <= 1e-12;
        EXPECT_TRUE(is_at_edge || std::abs(tendon - before[i]) <= 1e-12);
        tendons.pulled.push_back(tendon);
      }
      EXPECT_LE(largest_bend_error(fit_state(arm, drive, tendons).state, state), 1e-9);
    }
  });
}

TEST(FrictionPlay, WithoutFrictionTendonsFollowTheirSpools) {
  for_random_cases(20, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const Drive drive = random_drive(random, arm);
    FrictionPlay play(arm, drive, ArmState::straight(arm.sections.size()));
    const TendonDisplacements spools = tendon_displacements(arm, drive, random_bends(random, arm));
    EXPECT_EQ(play.follow(spools.pulled).bends, fit_state(arm, drive, spools).state.bends);
    EXPECT_EQ(play.spools(), spools.pulled);
    EXPECT_THROW(play.follow({}), std::invalid_argument);
  });
}

}  // namespace
}  // namespace flexura
