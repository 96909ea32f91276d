#include "flexura/mechanics/rod_target_problem.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "flexura/math/derivative_check.h"
#include "flexura/math/so3.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(RodTargetProblem, ItsDerivativesAreThoseByDifferences) {
  for_random_cases(8, [](TestRandom& random) {
    const std::vector<RodPlace> places = {{.section = 0, .at = 0.4}, {.section = 1, .at = 0.7}};
    Rod rod = two_section_robot();
    for (RodSection& section : rod.sections)
      section.modes = {.shear = 1, .stretch = 1, .bend = 2, .twist = 1};
    RodStatics statics(rod, places);
    RodTarget target{.position = random.vector<3>(-0.2, 0.4)};
    if (random.integer(0, 1) == 0)
      target.direction = random.vector<3>(-1.0, 1.0);
    else
      target.rotation = so3_exp(random.vector<3>(-1.5, 1.5));
    for (const RodPlace& place : places) target.places.push_back({place, random.vector<3>(-0.1, 0.3)});
    const RodLoads loads{.ends = {{.section = 1, .force = random.vector<3>(-0.1, 0.1)}}};
    const std::vector<double> most(6, 10);
    RodTargetProblem problem(statics, target, loads, most, 1e-9);
    problem.unit = 2;
    Eigen::VectorXd r(problem.row_count());
    Eigen::MatrixXd J(problem.row_count(), 6), unused(problem.row_count(), 6);
    Eigen::VectorXd x(6);
    for (double& value : x) value = random.uniform(0.1, 0.8);
    const Equilibrium at = problem.at(x, {}, r, J);
    ASSERT_TRUE(at.converged());
    const auto moved = [&](const Eigen::VectorXd& to) {
      Eigen::VectorXd there(problem.row_count());
      problem.at(to, at, there, unused);
      return there;
    };
    const NumericalJacobian numerical = numerical_jacobian(moved, x, 0.02);
    EXPECT_LE((J - numerical.value).cwiseAbs().maxCoeff(), 1e-7);
  });
}

}  // namespace
}  // namespace flexura
