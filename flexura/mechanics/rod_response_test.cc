#include "flexura/mechanics/rod_response.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/shaped_motion.h"
#include "flexura/mechanics/arm_rod.h"
#include "flexura/model/arm_model.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double degrees = std::numbers::pi / 180;

// Two wires in sleeves of the given mass per metre, each bent by three tendons to its end.
ArmConfig sleeved_arm(double mass, std::size_t arcs) {
  ArmConfig arm;
  arm.kind = ArmKind::spatial;
  arm.mechanics = ArmMechanics::statics;
  arm.gravity = {0, -9.81, 0};
  arm.section.resize(2);
  int count = 0;
  for (Section& section : arm.section) {
    section.length = 0.35;
    section.max_bend = 2.2;
    section.bend_profile.emplace(arcs, 1.0);
    section.material =
        MaterialConfig{.youngs_modulus = 54e9, .radius = std::array{2e-3, 2e-3}, .mass_per_length = mass};
    ++count;
    for (int i = 0; i < 3; ++i)
      arm.tendon.push_back({.section = count, .radius = 0.015, .angle = (120 * i + 40 * count) * degrees});
  }
  return arm;
}

DriveConfig taut_drive() {
  DriveConfig drive;
  drive.radius = 0.015;
  drive.pretension = 4;
  for (int section = 1; section <= 2; ++section)
    for (int i = 0; i < 3; ++i) {
      TendonConfig& tendon = drive.tendon.emplace_back();
      tendon.section = section;
      tendon.angle = (120 * i + 40 * section) * degrees;
    }
  return drive;
}

ArmState bent(TestRandom& random, double most) {
  ArmState state = ArmState::straight(2);
  for (Eigen::Vector2d& bend : state.bends) bend = {random.uniform(-most, most), random.uniform(-most, most)};
  return state;
}

// Tip under a command by a separate static solver, in the base's frame.
Pose tip_of(const ArmConfig& arm, const ArmState& command) {
  const Rod rod = rod_of(arm);
  RodStatics statics(rod);
  const Equilibrium at =
      statics.solve({.displacements = arc_displacements(rod, command).pulled}, loads_of(arm));
  EXPECT_TRUE(at.converged());
  return at.tip;
}

double tip_distance(const ArmConfig& arm, const ArmState& command) {
  const ArmModel model = arm_model_of(arm, std::nullopt);
  const Pose X_WB = model.driven().X_WB;
  return (model.backbone(command).tip().position - X_WB * tip_of(arm, command).position).norm();
}

TEST(RodResponse, IsTheChainOfArcsNearestToTheRod) {
  for_random_cases(10, [&](TestRandom& random) {
    const ArmState command = bent(random, 1);
    // More arcs are nearer.
    const double with_two = tip_distance(sleeved_arm(0.2, 2), command),
                 with_six = tip_distance(sleeved_arm(0.2, 6), command);
    EXPECT_LE(with_two, 6e-3);
    EXPECT_LE(with_six, 4e-4);
  });
}

TEST(RodResponse, OfAWeightlessRodIsNearlyWhatIsCommanded) {
  for_random_cases(10, [&](TestRandom& random) {
    ArmConfig arm = sleeved_arm(0, 2);
    for (Section& section : arm.section) section.material->modes = {.shear = 0, .stretch = 0};
    const ArmModel model = arm_model_of(arm, std::nullopt);
    const ArmState command = bent(random, 1), shape = model.actuation().shape(command);
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_LE((shape.bends[k] - command.bends[k / 2] / 2).norm(), 2e-3) << "arc " << k;
  });
}

TEST(RodResponse, ItsSlopesAreItsChangesWhereAllTendonsAreTaut) {
  ArmConfig arm = sleeved_arm(0.1, 3);
  arm.tendon.clear();
  const ArmModel model = arm_model_of(arm, taut_drive());
  for_random_cases(5, [&](TestRandom& random) {
    const ArmState command = bent(random, 0.15);
    Eigen::MatrixXd slopes;
    model.actuation().slopes(command, slopes);
    ASSERT_EQ(slopes.rows(), 18);
    ASSERT_EQ(slopes.cols(), 6);
    constexpr double h = 1e-4;
    for (std::size_t s = 0; s < 2; ++s)
      for (Eigen::Index axis = 0; axis < 2; ++axis) {
        ArmState up = command, down = command;
        up.bends[s][axis] += h, down.bends[s][axis] -= h;
        const ArmState high = model.actuation().shape(up), low = model.actuation().shape(down);
        for (std::size_t k = 0; k < 6; ++k) {
          const Eigen::Vector2d change = (high.bends[k] - low.bends[k]) / (2 * h);
          const Eigen::Vector2d slope =
              slopes.block<2, 1>(3 * static_cast<Eigen::Index>(k), 3 * static_cast<Eigen::Index>(s) + axis);
          EXPECT_LE((change - slope).norm(), 0.01) << "arc " << k << " by bend " << s << ' ' << axis;
        }
      }
  });
}

TEST(RodResponse, TellsTheCommandOfAShape) {
  const ArmModel model = arm_model_of(sleeved_arm(0.2, 3), std::nullopt);
  for_random_cases(10, [&](TestRandom& random) {
    const ArmState command = bent(random, 0.9);
    const ArmState shape = model.actuation().shape(command);
    const ArmState found = model.actuation().shape(model.actuation().command(shape));
    for (std::size_t k = 0; k < 6; ++k) EXPECT_LE((found.bends[k] - shape.bends[k]).norm(), 1e-9);
  });
}

TEST(RodResponse, InverseKinematicsUnderLoadReachTheTip) {
  ArmConfig arm = sleeved_arm(0.2, 6);
  arm.load.push_back({.section = 2, .force = {0.3, 0, 0.2}});
  const ArmModel model = arm_model_of(arm, std::nullopt);
  for_random_cases(5, [&](TestRandom& random) {
    const Eigen::Vector3d there = model.backbone(bent(random, 0.9)).tip().position;
    const InverseResult result = solve_inverse(model, TipTarget{.position = there}, {});
    ASSERT_TRUE(result.converged()) << name_of(result.outcome);
    const Eigen::Vector3d tip = model.driven().X_WB * tip_of(arm, result.state).position;
    EXPECT_LE((tip - there).norm(), 1e-3);
  });
}

// Steps by the derivative, undamped and no longer than `longest` rad, as a servo's law does. Returns the
// final distance of the arcs from the goal, rad.
double left_by_a_law(const ArmModel& model, const ArmState& goal, int steps) {
  constexpr double gain = 0.2, longest = 0.05;
  const std::size_t arcs = goal.bends.size();
  ArmState command = ArmState::straight(2);
  double left = 0;
  for (int step = 0; step < steps; ++step) {
    const ArmState shape = model.actuation().shape(command);
    Eigen::VectorXd error(2 * static_cast<Eigen::Index>(arcs));
    Eigen::MatrixXd slopes, by_bends(error.size(), 4);
    model.actuation().slopes(command, slopes);
    for (std::size_t k = 0; k < arcs; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      error.segment<2>(2 * row) = shape.bends[k] - goal.bends[k];
      for (Eigen::Index s = 0; s < 2; ++s)
        by_bends.block<2, 2>(2 * row, 2 * s) = slopes.block<2, 2>(3 * row, 3 * s);
    }
    left = error.cwiseAbs().maxCoeff();
    Eigen::Vector4d change = by_bends.colPivHouseholderQr().solve(-gain * error);
    change *= std::min(1.0, longest / change.norm());
    for (std::size_t s = 0; s < 2; ++s)
      command.bends[s] += change.segment<2>(2 * static_cast<Eigen::Index>(s));
  }
  return left;
}

TEST(RodResponse, ALawGoesOnWhereTendonsHangSlack) {
  for (const double mass : {0.0, 0.2}) {
    ArmConfig arm = sleeved_arm(mass, 3);
    for (Section& section : arm.section) section.material->youngs_modulus = 200e9;
    const ArmModel model = arm_model_of(arm, std::nullopt);
    for_random_cases(12, [&](TestRandom& random) {
      ArmState command = bent(random, 1.4);
      // Along one tendon, so that the two others of the section are slack.
      if (random.integer(0, 1) == 0)
        for (std::size_t s = 0; s < 2; ++s) {
          const double angle = (120 * random.integer(0, 2) + 40 * static_cast<double>(s + 1)) * degrees;
          command.bends[s] = random.uniform(0.5, 1.6) * Eigen::Vector2d(std::cos(angle), std::sin(angle));
        }
      EXPECT_LE(left_by_a_law(model, model.actuation().shape(command), 250), 1e-4) << mass << " kg/m";
    });
  }
}

TEST(RodResponse, HasNoShapeWhereTheArmComesToNoRest) {
  ArmConfig arm = sleeved_arm(0.2, 3);
  const ArmModel model = arm_model_of(arm, std::nullopt);
  ArmState nowhere = ArmState::straight(2);
  nowhere.stretches[1] = 0;
  const ArmState shape = model.actuation().shape(nowhere);
  ASSERT_EQ(shape.bends.size(), 6U);
  EXPECT_FALSE(shape.bends[0].allFinite());
  Eigen::MatrixXd slopes;
  model.actuation().slopes(nowhere, slopes);
  EXPECT_FALSE(slopes.allFinite());
  // An arm without equilibrium at zero command is rejected.
  arm.load.push_back({.section = 2, .force = {0, -1e9, 0}, .following = true});
  EXPECT_THROW((void)arm_model_of(arm, std::nullopt), std::invalid_argument);
}

TEST(RodResponse, SectionsAreDrivenLonger) {
  ArmConfig arm = sleeved_arm(0.02, 3);
  for (Section& section : arm.section) section.stretch_limits = {0.8, 1.4};
  const ArmModel model = arm_model_of(arm, std::nullopt);
  for_random_cases(5, [&](TestRandom& random) {
    ArmState command = bent(random, 0.5);
    for (double& stretch : command.stretches) stretch = random.uniform(0.9, 1.3);
    const ArmState shape = model.actuation().shape(command);
    Eigen::MatrixXd slopes;
    model.actuation().slopes(command, slopes);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(shape.stretches[k], command.stretches[k / 3], 2e-3);
      EXPECT_NEAR(slopes(3 * static_cast<Eigen::Index>(k) + 2, 3 * static_cast<Eigen::Index>(k / 3) + 2), 1,
                  0.02);
    }
  });
  ArmState nowhere = ArmState::straight(2);
  nowhere.stretches[0] = 0;
  EXPECT_FALSE(model.actuation().shape(nowhere).bends[0].allFinite());
}

TEST(RodResponse, AnswersTheSameWhateverWasAskedBefore) {
  TestRandom random(case_seed(0));
  const ArmModel one = arm_model_of(sleeved_arm(0.2, 3), std::nullopt),
                 other = arm_model_of(sleeved_arm(0.2, 3), std::nullopt);
  const ArmState command = bent(random, 0.9), before = bent(random, 0.9);
  Eigen::MatrixXd slopes, again;
  one.actuation().slopes(before, slopes);
  const ArmState shape = one.actuation().shape(command);
  one.actuation().slopes(command, slopes);
  other.actuation().slopes(command, again);
  EXPECT_EQ(shape, other.actuation().shape(command));
  EXPECT_EQ(slopes, again);
}

TEST(RodResponse, OfAnotherArmIsRefused) {
  ArmConfig arm = sleeved_arm(0.2, 3);
  const ArmModel model = arm_model_of(arm, std::nullopt);
  EXPECT_THROW((void)model.actuation().shape(ArmState::straight(3)), std::invalid_argument);
  Rod rod = rod_of(arm);
  rod.sections.pop_back();
  rod.tendons.resize(3);
  EXPECT_THROW(RodResponse(arm.arm(), rod, {}, std::nullopt), std::invalid_argument);
  DriveConfig drive = taut_drive();
  drive.tendon.pop_back();
  EXPECT_THROW((void)arm_model_of(arm, drive), std::invalid_argument);
}

TEST(RodResponse, BelievesThreeArcsASectionWhereNothingElseIsSaid) {
  ArmConfig arm = sleeved_arm(0.2, 1);
  for (Section& section : arm.section) section.bend_profile.reset();
  const ArmModel model = arm_model_of(arm, std::nullopt);
  EXPECT_EQ(model.actuation().arcs(), 6U);
  EXPECT_FALSE(model.actuation().is_identity());
  // Even one arc a section differs from the command.
  const ArmModel one = arm_model_of(sleeved_arm(0.2, 1), std::nullopt);
  EXPECT_FALSE(one.actuation().is_identity());
  EXPECT_EQ(one.shaped().sections[0].max_bend, std::numeric_limits<double>::infinity());
}

TEST(ArcDisplacements, TheirSlopesAreTheirDerivatives) {
  for_random_cases(20, [&](TestRandom& random) {
    ArmConfig arm = sleeved_arm(0, 1);
    arm.tendon[1].turns = random.uniform(-1, 1);
    arm.tendon[4].end_radius = 0.01;
    Rod rod = rod_of(arm);
    rod.sections[1].disks = random.integer(0, 1) == 0 ? 0 : 6;
    ArmState state = bent(random, 1.5);
    for (double& stretch : state.stretches) stretch = random.uniform(0.8, 1.2);
    const Eigen::MatrixXd slopes = arc_displacement_slopes(rod, state);
    constexpr double h = 1e-6;
    for (std::size_t s = 0; s < 2; ++s)
      for (Eigen::Index c = 0; c < 3; ++c) {
        ArmState up = state, down = state;
        (c < 2 ? up.bends[s][c] : up.stretches[s]) += h;
        (c < 2 ? down.bends[s][c] : down.stretches[s]) -= h;
        const std::vector<double> high = arc_displacements(rod, up).pulled,
                                  low = arc_displacements(rod, down).pulled;
        for (std::size_t t = 0; t < rod.tendons.size(); ++t)
          EXPECT_NEAR(slopes(static_cast<Eigen::Index>(t), 3 * static_cast<Eigen::Index>(s) + c),
                      (high[t] - low[t]) / (2 * h), 1e-9);
      }
  });
}

}  // namespace
}  // namespace flexura
