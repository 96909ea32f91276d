#include "flexura/mechanics/arc_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

struct FittedArm {
  Arm arm;
  ArmState state;
  std::vector<MaterialPoint> places;
};

// An arm with up to `most` arcs, some of which stretch, and three to six places on each.
FittedArm fitted_arm(TestRandom& random, int most) {
  FittedArm made;
  made.arm.kind = random.integer(0, 2) == 0 ? ArmKind::planar : ArmKind::spatial;
  made.arm.sections.resize(static_cast<std::size_t>(random.integer(1, most)));
  made.state = ArmState::straight(made.arm.sections.size());
  for (std::size_t k = 0; k < made.arm.sections.size(); ++k) {
    Section& section = made.arm.sections[k];
    section.length = random.uniform(0.05, 0.2);
    if (random.integer(0, 1) == 0) section.stretch_limits = {0.5, 2};
    made.state.bends[k].x() = random.uniform(-0.5, 0.5);
    if (made.arm.kind == ArmKind::spatial) made.state.bends[k].y() = random.uniform(-0.5, 0.5);
    if (section.can_stretch()) made.state.stretches[k] = random.uniform(0.8, 1.2);
    const int count = random.integer(3, 6);
    for (int i = 1; i <= count; ++i) made.places.push_back({k, static_cast<double>(i) / count});
  }
  return made;
}

Eigen::MatrixXd dense_jacobian(const FittedArm& fitted, const ArmVariables& variables) {
  const BackboneJacobian jacobian(fitted.arm, fitted.state);
  Eigen::MatrixXd J =
      Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(fitted.places.size()), variables.size());
  Jacobian columns(6, 3 * static_cast<Eigen::Index>(fitted.arm.sections.size()));
  for (std::size_t p = 0; p < fitted.places.size(); ++p) {
    jacobian.at(fitted.places[p], columns);
    const auto row = 3 * static_cast<Eigen::Index>(p);
    for (std::size_t k = 0; k < variables.parts().size(); ++k) {
      const ArmVariables::Part& part = variables.parts()[k];
      const auto from = 3 * static_cast<Eigen::Index>(k);
      J.block<3, 1>(row, part.at) = columns.block<3, 1>(0, from);
      if (part.is_spatial) J.block<3, 1>(row, part.at + 1) = columns.block<3, 1>(0, from + 1);
      if (part.is_stretchable) J.block<3, 1>(row, part.stretch_at()) = columns.block<3, 1>(0, from + 2);
    }
  }
  return J;
}

TEST(ArcFit, IsTheLeastSquaresOfTheDenseJacobian) {
  for_random_cases(30, [&](TestRandom& random) {
    const FittedArm fitted = fitted_arm(random, 12);
    const ArmVariables variables(fitted.arm);
    const Eigen::MatrixXd J = dense_jacobian(fitted, variables);
    Eigen::MatrixXd moved(J.rows(), 3);
    for (double& each : moved.reshaped()) each = random.uniform(-1e-3, 1e-3);
    ArcFit fit(variables, fitted.places);
    fit.set(fitted.arm, fitted.state);
    Eigen::MatrixXd reached;
    const Eigen::MatrixXd change = fit.solve(moved, &reached),
                          expected = J.colPivHouseholderQr().solve(moved);
    ASSERT_EQ(change.rows(), variables.size());
    EXPECT_LE((change - expected).norm(), 1e-9 * expected.norm());
    EXPECT_LE((reached - J * change).norm(), 1e-12 * moved.norm());
    for (std::size_t p = 0; p < fitted.places.size(); ++p)
      EXPECT_LE((fit.position(p) - BackboneJacobian(fitted.arm, fitted.state).pose(fitted.places[p]).position)
                    .norm(),
                1e-14);
  });
}

// Many arcs do not lose digits: the gradient of the sum of squares is 0.
TEST(ArcFit, StaysExactForManyArcs) {
  TestRandom random(case_seed(0));
  FittedArm fitted;
  fitted.arm.kind = ArmKind::spatial;
  fitted.arm.sections.resize(120);
  fitted.state = ArmState::straight(120);
  for (std::size_t k = 0; k < 120; ++k) {
    fitted.arm.sections[k].length = 0.01;
    fitted.state.bends[k] = {random.uniform(-0.05, 0.1), random.uniform(-0.05, 0.1)};
    for (const double at : {0.25, 0.5, 0.75, 1.0}) fitted.places.push_back({k, at});
  }
  const ArmVariables variables(fitted.arm);
  const Eigen::MatrixXd J = dense_jacobian(fitted, variables);
  // Displacements that arcs can reach, and some that they cannot.
  Eigen::VectorXd change(variables.size()), noise(J.rows());
  for (double& each : change) each = random.uniform(-1e-3, 1e-3);
  for (double& each : noise) each = random.uniform(-1e-6, 1e-6);
  ArcFit fit(variables, fitted.places);
  fit.set(fitted.arm, fitted.state);
  const Eigen::VectorXd found = fit.solve(J * change + noise);
  const Eigen::VectorXd left = J * (change - found) + noise;
  EXPECT_LE((J.transpose() * left).norm(), 1e-9 * J.norm() * noise.norm());
  EXPECT_LE((fit.solve(J * change) - change).norm(), 1e-9 * change.norm());
}

TEST(ArcFit, RefusesTheStateOfAnotherArm) {
  TestRandom random(case_seed(0));
  const FittedArm fitted = fitted_arm(random, 4);
  ArcFit fit(ArmVariables(fitted.arm), fitted.places);
  EXPECT_THROW(fit.set(fitted.arm, ArmState::straight(fitted.arm.sections.size() + 1)),
               std::invalid_argument);
}

}  // namespace
}  // namespace flexura
