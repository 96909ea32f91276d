#include "flexura/kinematics/jacobian.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

#include "flexura/math/derivative_check.h"
#include "flexura/math/so3.h"
#include "tests/support/arms.h"

namespace flexura {
namespace {

// Returns the Jacobian from differences of poses, independent of its derivation.
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
  Jacobian J = Jacobian::Constant(6, 3 * static_cast<Eigen::Index>(arm.sections.size()), 7.0);
  const BackboneJacobian backbone(arm, state);
  backbone.at(point, J);
  const Pose by_length = Backbone(arm, state).pose(arc_length_of(arm, state, point));
  EXPECT_LE((backbone.pose(point).position - by_length.position).norm(), 1e-13);
  const NumericalJacobian numerical = by_differences(arm, state, point);
  EXPECT_LE(numerical.error.maxCoeff(), 1e-9);
  EXPECT_LE((J - numerical.value).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Jacobian, IsTheDerivativeAnywhereOnRandomArms) {
  for_random_cases(150, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const ArmState state = random_state(random, arm);
    expect_analytic_equals_numerical(arm, state, {arm.sections.size() - 1, 1.0});
    expect_analytic_equals_numerical(arm, state, {0, 0.0});
    expect_analytic_equals_numerical(arm, state, material_point(arm, random.uniform(0.0, arm.length())));
  });
}

TEST(Jacobian, IsTheDerivativeAtEverySizeOfBend) {
  for (const double bend :
       {0.0, 1e-300, 1e-12, 1e-8, 1e-4, 0.1, 1.499, 1.501, 3.0, std::numbers::pi, 6.28, 9.0, 12.5}) {
    SCOPED_TRACE(bend);
    for_random_cases(3, [bend](TestRandom& random) {
      Arm arm = random_arm(random);
      ArmState state = random_state(random, arm);
      for (Eigen::Vector2d& b : state.bends) b = bend * random.vector<2>(-1.0, 1.0).normalized();
      expect_analytic_equals_numerical(arm, state, {arm.sections.size() - 1, 1.0});
    });
  }
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
