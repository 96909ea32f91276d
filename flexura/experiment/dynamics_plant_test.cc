#include "flexura/tasks/dynamics/dynamics_plant.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/schedule.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"
#include "tests/support/dynamics_files.h"
#include "tests/support/quiet.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

Arm uneven_arm(TestRandom& random, ArmKind kind) {
  Arm arm;
  arm.kind = kind;
  arm.X_WB.position = random.vector<3>(-1, 1);
  const Eigen::Vector3d turn = kind == ArmKind::planar ? Eigen::Vector3d(0, 0, random.uniform(-2, 2))
                                                       : Eigen::Vector3d(random.vector<3>(-0.4, 0.4));
  arm.X_WB.rotation = so3_exp(turn) * arm.X_WB.rotation;
  for (int i = random.integer(1, 4); i > 0; --i) arm.sections.push_back({.length = random.uniform(0.2, 0.6)});
  return arm;
}

TEST(DynamicsPlant, IsTheArmItselfInAPlane) {
  for_random_cases(40, [](TestRandom& random) {
    const Arm arm = uneven_arm(random, ArmKind::planar);
    ArmState state = ArmState::straight(arm.sections.size());
    // Including more than half a turn per section, and stretch.
    for (Eigen::Vector2d& bend : state.bends) bend.x() = random.uniform(-5, 5);
    for (double& stretch : state.stretches) stretch = random.uniform(0.8, 1.2);
    const bool has_lengths = random.integer(0, 1) == 1;
    DynamicsTask task;
    task.variable_lengths = has_lengths;
    const DynamicsPlant plant(task, arm, state);
    const ArmState back = plant.state(plant.start(), state);
    for (std::size_t i = 0; i < state.bends.size(); ++i) {
      EXPECT_NEAR((back.bends[i] - state.bends[i]).norm(), 0, 1e-9);
      EXPECT_NEAR(back.stretches[i], state.stretches[i], 1e-12);
    }
    // Its positions must be those of the arcs.
    DistributedArm distributed = plant.distributed();
    distributed.set(plant.start(), Eigen::VectorXd::Zero(plant.start().size()));
    EXPECT_LE((plant.base() + distributed.tip() - Backbone(arm, state).tip().position).norm(), 1e-4);
  });
}

TEST(DynamicsPlant, HasTheDirectionsAtTheSectionsEnds) {
  for_random_cases(40, [](TestRandom& random) {
    const Arm arm = uneven_arm(random, ArmKind::spatial);
    ArmState state = ArmState::straight(arm.sections.size()), before = state;
    for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-0.3, 0.3);
    const DynamicsPlant plant(DynamicsTask{}, arm, state);
    const ArmState back = plant.state(plant.start(), before);
    const Eigen::Matrix2Xd ends = plant.end_angles(plant.start());
    const Backbone backbone(arm, back), desired(arm, state);
    for (std::size_t i = 0; i < state.bends.size(); ++i) {
      const Eigen::Vector3d e = i + 1 < state.bends.size() ? backbone.arcs()[i + 1].X_WS.rotation.col(2)
                                                           : backbone.tip().rotation.col(2);
      const auto k = static_cast<Eigen::Index>(i);
      EXPECT_NEAR(std::atan2(e.x(), e.y()), ends(0, k), 1e-9);
      EXPECT_NEAR(std::asin(e.z()), ends(1, k), 1e-9);
      EXPECT_LE((back.bends[i] - state.bends[i]).norm(), 1e-9);
    }
  });
}

TEST(DynamicsPlant, TakesAPolynomialThroughManyNodes) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections = {{.length = 0.5}};
  const ArmState state{{{0.9, -0.7}}, {1}};
  DynamicsTask task;
  task.basis = AngleBasis::polynomial, task.nodes = 8;
  const DynamicsPlant plant(task, arm, state);
  DistributedArm distributed = plant.distributed();
  distributed.set(plant.start(), Eigen::VectorXd::Zero(plant.start().size()));
  EXPECT_LE((distributed.tip() - Backbone(arm, state).tip().position).norm(), 1e-6);
}

// An azimuth is an angle: additional whole turns are the same direction.
TEST(DynamicsPlant, TakesNoTurnsForAnotherShape) {
  constexpr double turn = 2 * std::numbers::pi;
  for_random_cases(40, [](TestRandom& random) {
    Arm arm = uneven_arm(random, random.integer(0, 1) == 0 ? ArmKind::planar : ArmKind::spatial);
    if (random.integer(0, 1) == 0) arm.X_WB.rotation = so3_exp({0, 0, 3}) * arm.X_WB.rotation;
    const ArmState straight = ArmState::straight(arm.sections.size());
    const Eigen::Vector2d base = AnglesAlongArm(arm, straight).at(0, 0);
    DynamicsTask task;
    task.basis = random.integer(0, 1) == 0 ? AngleBasis::sections : AngleBasis::polynomial;
    std::vector<double> azimuths = {base[0]}, elevations = {base[1]};
    for (int i = random.integer(1, 6); i > 0; --i) {
      azimuths.push_back(azimuths.back() + random.uniform(-1.5, 1.5));
      elevations.push_back(0);
    }
    task.target.azimuths = azimuths, task.target.elevations = elevations;
    const Eigen::VectorXd target = DynamicsPlant(task, arm, straight).target();
    const int turns = random.integer(-3, 3);
    for (double& azimuth : azimuths) azimuth += turn * turns;
    task.target.azimuths = azimuths;
    EXPECT_LE((DynamicsPlant(task, arm, straight).target() - target).cwiseAbs().maxCoeff(), 1e-12);
  });
}

TEST(AnglesAlongArm, GoOnContinuouslyFromTheBase) {
  Arm arm;
  arm.sections = {{.length = 1}, {.length = 1}};
  const AnglesAlongArm angles(arm, {{{5, 0}, {4, 0}}, {1, 1}});
  EXPECT_NEAR(angles.at(0, 0)[0], 0, 1e-12);
  EXPECT_NEAR(angles.at(0, 0.5)[0], 2.5, 1e-9);
  EXPECT_NEAR(angles.at(1, 0)[0], 5, 1e-9);
  EXPECT_NEAR(angles.at(1, 1)[0], 9, 1e-9);
  EXPECT_LT(angles.largest_elevation(), 0.03);  // Chords of steps along it.
  arm.kind = ArmKind::spatial;
  EXPECT_NEAR(AnglesAlongArm(arm, {{{0, -1}, {0, 0}}, {1, 1}}).largest_elevation(), 1, 1e-9);
}

// With nearly half a turn and out of a plane, a section is not an arc.
TEST(DynamicsPlant, IsToldOfWhereTheCheckJudgesAnotherShape) {
  const auto caveats = [&](int degrees) {
    const std::string file =
        "[arm]\nkind = \"spatial\"\n[[arm.section]]\nlength = 1\nradius = 0.02\n" +
        dynamics_task(
            fmt::format("target.azimuths_deg = [0, {}]\ntarget.elevations_deg = [0, 20]\n", degrees));
    Quiet quiet;
    return check_experiment_safety(parse_experiment(file, "x.toml", {{}, {}}), quiet).caveats;
  };
  EXPECT_THAT(caveats(172), testing::Contains(testing::HasSubstr(
                                "the check approximates the arm by arcs, with an error of up to")));
  EXPECT_THAT(caveats(5),
              testing::Not(testing::Contains(testing::HasSubstr("the check approximates the arm by arcs"))));
}

}  // namespace
}  // namespace flexura
