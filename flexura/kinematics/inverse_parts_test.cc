// Tests the parts of inverse kinematics: derivatives, bounds, and proofs of unreachability.
#include <gtest/gtest.h>

#include <numbers>

#include "flexura/kinematics/arc_motion.h"
#include "flexura/kinematics/bounds.h"
#include "flexura/kinematics/curve_problem.h"
#include "flexura/kinematics/jacobian.h"
#include "flexura/kinematics/reach.h"
#include "flexura/kinematics/tip_problem.h"
#include "flexura/math/derivative_check.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"
#include "tests/support/arms.h"
#include "tests/support/inverse_targets.h"

namespace flexura {
namespace {

TEST(ArcMotion, IsTheArcsPoseAndItsDerivativeAtEverySizeOfBend) {
  for (const double bend : {0.0, 1e-300, 1e-12, 1e-4, 0.1, 0.4999, 0.5001, 1.5, 3.0, 6.28, 9.0, 12.5}) {
    SCOPED_TRACE(bend);
    for_random_cases(5, [bend](TestRandom& random) {
      Arm arm;
      arm.kind = ArmKind::spatial;
      arm.X_WB = Pose{};
      arm.sections.emplace_back().length = 0.7;
      ArmState state = ArmState::straight(1);
      state.bends[0] = bend * random.vector<2>(-1.0, 1.0).normalized();
      const ArcMotion motion = arc_motion(state.bends[0], 0.7);
      const Pose pose = arc_pose(state.bends[0], 0.7);
      EXPECT_LE((motion.position - pose.position).norm(), 1e-15);
      EXPECT_LE((motion.rotation - pose.rotation).norm(), 2e-15);
      const Jacobian J = tip_jacobian(arm, state);
      EXPECT_LE((motion.linear - J.topLeftCorner<3, 2>()).norm(), 3e-15);
      EXPECT_LE((motion.angular - J.bottomLeftCorner<3, 2>()).norm(), 5e-15);
    });
  }
}

// Returns an arm of one to four sections, some stretchable, planar or spatial.
Arm some_arm(TestRandom& random) {
  Arm arm;
  arm.kind = random.integer(0, 2) == 0 ? ArmKind::planar : ArmKind::spatial;
  const int count = random.integer(1, 4);
  for (int i = 0; i < count; ++i) {
    Section& section = arm.sections.emplace_back();
    section.length = random.uniform(0.2, 1.0);
    section.max_bend = random.uniform(0.5, 3.0);
    if (random.integer(0, 1) == 0) section.stretch_limits = {0.7, 1.4};
  }
  return arm;
}

void expect_gradient_is_the_derivative(TipRows rows, TestRandom& random) {
  const Arm arm = some_arm(random);
  const ArmVariables variables(arm);
  const Pose X_BT{so3_exp(random.vector<3>(-1.5, 1.5)), random.vector<3>(-1.0, 1.0)};
  TipProblem problem(rows, variables, X_BT, 2.0, 1e-9, 1e-9);
  Eigen::VectorXd r(problem.row_count());
  Eigen::MatrixXd J(problem.row_count(), variables.size());
  const auto half_square = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
    problem.linearise(at, r, J);
    return Eigen::VectorXd::Constant(1, 0.5 * r.squaredNorm());
  };
  const auto position = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
    problem.linearise(at, r, J);
    return r.head<3>();
  };
  const Eigen::VectorXd x = variables.pack(random_state_within(random, arm));
  problem.linearise(x, r, J);
  const Eigen::VectorXd gradient = J.transpose() * r;
  const Eigen::MatrixXd by_position = J.topRows(3);
  EXPECT_LE((numerical_jacobian(half_square, x, 0.02).value.transpose() - gradient).norm(), 1e-8);
  EXPECT_LE((numerical_jacobian(position, x, 0.02).value - by_position).norm(), 1e-8);
}

TEST(TipProblem, GivesTheDerivativeOfItsSquareAndOfThePosition) {
  for_random_cases(50, [](TestRandom& random) {
    for (const TipRows rows : {TipRows::position, TipRows::direction, TipRows::rotation})
      expect_gradient_is_the_derivative(rows, random);
  });
}

TEST(TipProblem, MeasuresAnglesInRadians) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.emplace_back().length = 1.0;
  const ArmVariables variables(arm);
  const Eigen::VectorXd straight = Eigen::VectorXd::Zero(2);
  for (const double angle : {1e-9, 0.5, 3.0, std::numbers::pi}) {
    const Pose X_BT{so3_exp({0.0, angle, 0.0}), {0.0, 0.0, 1.0}};
    for (const TipRows rows : {TipRows::direction, TipRows::rotation}) {
      TipProblem problem(rows, variables, X_BT, 1.0, 1e-9, 1e-9);
      Eigen::VectorXd r(problem.row_count());
      Eigen::MatrixXd J(problem.row_count(), 2);
      problem.linearise(straight, r, J);
      EXPECT_NEAR(r.norm(), angle, 1e-14);
    }
  }
}

TEST(CurveProblem, GivesTheDerivativeOfItsResidual) {
  for_random_cases(30, [](TestRandom& random) {
    const Arm arm = some_arm(random);
    const ArmVariables variables(arm);
    std::vector<Eigen::Vector3d> points(7);
    for (Eigen::Vector3d& point : points) point = random.vector<3>(-1.0, 1.0);
    CurveProblem problem(variables, points, 1.0);
    Eigen::VectorXd r(problem.row_count());
    Eigen::MatrixXd J(problem.row_count(), variables.size());
    const Eigen::VectorXd x = variables.pack(random_state_within(random, arm));
    const auto half_square = [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
      problem.linearise(at, r, J);
      return Eigen::VectorXd::Constant(1, 0.5 * r.squaredNorm());
    };
    // If a point crosses from one section into the next, its second derivative jumps: fewer digits.
    const Eigen::MatrixXd numerical = numerical_jacobian(half_square, x, 1e-3).value;
    problem.linearise(x, r, J);
    EXPECT_LE((numerical.transpose() - J.transpose() * r).norm(), 1e-6);
  });
}

TEST(Bounds, ProjectNeverLeavesThemByAnUlp) {
  for_random_cases(2000, [](TestRandom& random) {
    const Bounds bounds = {Bound::disk(0, random.uniform(0.01, 4.0)), Bound::interval(2, 0.8, 1.1)};
    Eigen::VectorXd x = random.vector<3>(-9.0, 9.0);
    const Eigen::Vector2d direction = x.head<2>().normalized();
    project(bounds, x);
    EXPECT_LE(x.head<2>().norm(), bounds[0].high);
    EXPECT_LE((x.head<2>() - x.head<2>().norm() * direction).norm(), 1e-15);
    EXPECT_GE(x[2], 0.8);
    EXPECT_LE(x[2], 1.1);
    const Eigen::VectorXd once = x;
    project(bounds, x);
    EXPECT_EQ(x, once);
  });
}

TEST(Bounds, OnlyWhatPushesOutIsHeld) {
  const Bounds bounds = {Bound::disk(0, 1.0), Bound::interval(2, 0.0, 1.0)};
  const Eigen::VectorXd x = Eigen::Vector3d(0.6, 0.8, 1.0);
  Eigen::VectorXd gradient = Eigen::Vector3d(-3.0, -4.0, -2.0);
  EXPECT_NEAR(pressure(bounds, x, gradient), std::sqrt(29.0), 1e-14);
  free_gradient(bounds, x, gradient);
  EXPECT_LE(gradient.norm(), 1e-14);
  gradient = Eigen::Vector3d(3.0, 4.0, 2.0);
  EXPECT_EQ(pressure(bounds, x, gradient), 0.0);
  free_gradient(bounds, x, gradient);
  EXPECT_EQ(gradient.norm(), Eigen::Vector3d(3.0, 4.0, 2.0).norm());
}

TEST(Reach, ProvesNothingAboutWhatIsReached) {
  for_random_cases(5000, [](TestRandom& random) {
    Arm arm = some_arm(random);
    if (random.integer(0, 3) == 0) arm.sections.back().max_bend = std::numeric_limits<double>::infinity();
    if (random.integer(0, 3) == 0) arm.sections.front().max_bend = random.uniform(3.0, 6.2);
    // Half the states are at the limits, where the bounds are tight.
    ArmState state = random_state_within(random, arm);
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      if (random.integer(0, 1) == 0 || std::isinf(arm.sections[i].max_bend)) continue;
      const double side = random.integer(0, 1) == 0 ? 1.0 : -1.0;
      state.bends[i] = {side * arm.sections[i].max_bend, 0.0};
    }
    const Pose X_BT = arm.X_WB.inverse() * tip_pose(arm, state);
    EXPECT_LE(least_distance(arm, X_BT.position), 1e-13);
    EXPECT_LE(least_distance_along(arm, X_BT), 1e-13);
    EXPECT_LE(least_angle(arm, Eigen::Vector3d(X_BT.rotation.col(2))), 1e-13);
    EXPECT_LE(least_angle(arm, X_BT.rotation), 1e-13);
  });
}

TEST(Reach, IsTightWhereTheNearestPoseIsKnown) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (int i = 0; i < 3; ++i) {
    arm.sections.emplace_back().length = 0.3;
    arm.sections.back().max_bend = 0.9;
  }
  // Straight ahead; and the middle of the hole, to which the fully bent arc is the nearest.
  EXPECT_NEAR(least_distance(arm, {0.0, 0.0, 1.0}), 0.1, 1e-12);
  const double chord = 0.9 * std::sin(1.35) / 1.35;
  EXPECT_NEAR(least_distance(arm, Eigen::Vector3d::Zero()), chord, 1e-12);
  EXPECT_NEAR(least_angle(arm, Eigen::Vector3d(-Eigen::Vector3d::UnitZ())), std::numbers::pi - 2.7, 1e-12);
  arm.kind = ArmKind::planar;
  EXPECT_NEAR(least_distance(arm, {0.0, 0.4, 0.8}), 0.4, 1e-12);
}

}  // namespace
}  // namespace flexura
