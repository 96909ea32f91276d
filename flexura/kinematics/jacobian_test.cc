#include "flexura/kinematics/jacobian.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

#include "flexura/math/derivative_check.h"
#include "flexura/math/so3.h"
#include "tests/support/arms.h"

namespace flexura {
namespace {

// The Jacobian by differences of poses that know nothing of its derivation.
NumericalJacobian by_differences(const Arm& arm, const ArmState& state, const MaterialPoint& point) {
  const auto pose_of = [&](const ArmState& at) {
    return Backbone(arm, at).pose(arc_length_of(arm, at, point));
  };
  const Pose now = pose_of(state);
  const VectorFunction move = [&](const Eigen::VectorXd& q) -> Eigen::VectorXd {
    const Pose moved = pose_of(unpacked(q));
    Eigen::Vector<double, 6> result;
    result << moved.position, so3_log(moved.rotation * now.rotation.transpose());
    return result;
  };
  return numerical_jacobian(move, packed(state));
}

void expect_analytic_equals_numerical(const Arm& arm, const ArmState& state, const MaterialPoint& point) {
  Jacobian J(6, 3 * static_cast<Eigen::Index>(arm.sections.size()));
  BackboneJacobian(arm, state).at(point, J);
  const NumericalJacobian numerical = by_differences(arm, state, point);
  EXPECT_LE(numerical.error.maxCoeff(), 1e-9);
  EXPECT_LE((J - numerical.value).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Jacobian, IsTheDerivativeAnywhereOnRandomArms) {
  for_random_cases(150, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const ArmState state = random_state(random, arm);
    expect_analytic_equals_numerical(arm, state, {arm.sections.size() - 1, 1.0});
    expect_analytic_equals_numerical(arm, state, material_point(arm, random.uniform(0.0, arm.length())));
  });
}

TEST(Jacobian, IsTheDerivativeAtEverySizeOfBend) {
  for (const double bend :
       {0.0, 1e-12, 1e-8, 1e-4, 0.1, 1.499, 1.501, 3.0, std::numbers::pi, 6.28, 9.0, 12.5}) {
    SCOPED_TRACE(bend);
    for_random_cases(3, [bend](TestRandom& random) {
      Arm arm = random_arm(random);
      ArmState state = random_state(random, arm);
      for (Eigen::Vector2d& b : state.bends) b = bend * random.vector<2>(-1.0, 1.0).normalized();
      expect_analytic_equals_numerical(arm, state, {arm.sections.size() - 1, 1.0});
    });
  }
}

TEST(Jacobian, OfAStraightSectionIsInClosedForm) {
  Arm arm;
  arm.X_WB = Pose{};
  arm.sections.emplace_back().length = 2.0;
  // Half the length sideways and a whole turn a bend; the length along z a stretch.
  Jacobian expected(6, 3);
  expected << 1, 0, 0, 0, 1, 0, 0, 0, 2, 0, -1, 0, 1, 0, 0, 0, 0, 0;
  EXPECT_LE((tip_jacobian(arm, ArmState::straight(1)) - expected).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Jacobian, DoesNotJumpFromStraightToAlmostStraight) {
  const Arm arm = paper_arm();
  ArmState state = ArmState::straight(8);
  const Jacobian straight = tip_jacobian(arm, state);
  for (Eigen::Vector2d& bend : state.bends) bend = {1e-12, -1e-12};
  EXPECT_LE((tip_jacobian(arm, state) - straight).cwiseAbs().maxCoeff(), 5e-10);
  for (Eigen::Vector2d& bend : state.bends) bend = {1e-300, 0.0};
  EXPECT_LE((tip_jacobian(arm, state) - straight).cwiseAbs().maxCoeff(), 1e-297);
}

TEST(Jacobian, SectionsPastThePointDoNotMoveIt) {
  for_random_cases(30, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const BackboneJacobian jacobian(arm, random_state(random, arm));
    Jacobian J = Jacobian::Constant(6, 3 * static_cast<Eigen::Index>(arm.sections.size()), 7.0);
    const MaterialPoint point = material_point(arm, random.uniform(0.0, arm.length()));
    jacobian.at(point, J);
    const Eigen::Index past = 3 * static_cast<Eigen::Index>(point.section + 1);
    EXPECT_EQ(J.rightCols(J.cols() - past).cwiseAbs().sum(), 0.0);
  });
}

TEST(Jacobian, IsContinuousWhereSectionsMeet) {
  for_random_cases(50, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const BackboneJacobian jacobian(arm, random_state(random, arm));
    const Eigen::Index columns = 3 * static_cast<Eigen::Index>(arm.sections.size());
    Jacobian before(6, columns);
    Jacobian after(6, columns);
    for (std::size_t i = 1; i < arm.sections.size(); ++i) {
      jacobian.at({i - 1, 1.0}, before);
      jacobian.at({i, 0.0}, after);
      EXPECT_LE((after - before).cwiseAbs().maxCoeff(), 1e-13);
    }
  });
}

TEST(Jacobian, OfTheWholeBackboneIsThatOfEachPoint) {
  const Arm arm = paper_arm();
  const std::vector<MaterialPoint> points = {{0, 0.0}, {3, 0.25}, {7, 1.0}};
  const std::vector<Jacobian> all = backbone_jacobians(arm, paper_state(), points);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0].cwiseAbs().sum(), 0.0);
  EXPECT_EQ(all[2], tip_jacobian(arm, paper_state()));
  const BackboneJacobian jacobian(arm, paper_state());
  Jacobian J(6, 24);
  jacobian.at(points[1], J);
  EXPECT_EQ(all[1], J);
  EXPECT_LE((jacobian.pose(points[1]).position - Backbone(arm, paper_state()).pose(6.5).position).norm(),
            1e-14);
}

TEST(Jacobian, RefusesAMatrixOrAPointThatDoesNotFit) {
  const BackboneJacobian jacobian(paper_arm(), paper_state());
  Jacobian J(6, 21);
  EXPECT_THROW(jacobian.tip(J), std::invalid_argument);
  Jacobian fits(6, 24);
  EXPECT_THROW(jacobian.at({8, 0.0}, fits), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
