#include "flexura/estimate/shape_problem.h"

#include <gtest/gtest.h>

#include "flexura/math/derivative_check.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(ShapeProblem, HasTheDerivativesOfItsResiduals) {
  for_random_cases(20, [](TestRandom& random) {
    ShapePrior prior{.arm = three_section_arm()};
    prior.is_base_position_known = random.integer(0, 1) == 1;
    prior.is_base_direction_known = random.integer(0, 1) == 1;
    prior.is_length_known = random.integer(0, 1) == 1;
    if (random.integer(0, 1) == 1) prior.curvature_step = 3;
    Shape shape{prior.arm, random_bends(random, prior.arm, 1.5)};
    const int with_prior = random.integer(0, 3);
    const Backbone backbone(shape.arm, shape.state);
    std::vector<Observation> seen;
    for (const View& view : two_views()) {
      seen.push_back(observation_of(backbone, view, random, 0.2, {0.05, 0.95}, 15));
      for (const double s : {0.3, 0.5, 0.7})
        seen.back().borders.push_back(
            {view.project(backbone.pose(s).position).value() + random.vector<2>(-9, 9), 0.5});
      seen.back().markers.push_back({view.project(backbone.pose(0.4).position).value(), 0.37, 0.1});
      ViewError& error = shape.views.emplace_back();
      const bool has_prior = (with_prior >> (seen.size() - 1)) % 2 == 1;
      if (!has_prior) continue;
      seen.back().view_prior = {0.02, random.integer(0, 1) == 1 ? 0.01 : 0};
      error = {random.vector<3>(-0.03, 0.03), random.uniform(-0.02, 0.02)};
    }
    ShapeProblem problem(prior, seen);
    const auto residuals = [&](const Eigen::VectorXd& step) -> Eigen::VectorXd {
      EXPECT_TRUE(problem.linearise(problem.variables().plus(shape, step)));
      return problem.residuals();
    };
    const NumericalJacobian expected =
        numerical_jacobian(residuals, Eigen::VectorXd::Zero(problem.variables().count()), 1e-3);
    ASSERT_TRUE(problem.linearise(shape));
    for (Eigen::Index row = 0; row < problem.rows(); ++row) {
      const Eigen::RowVectorXd there = problem.derivatives().row(row);
      // The change of the tube's apparent radius with its distance is neglected.
      const double close = problem.kind(row) == ShapeProblem::RowKind::border ? 5e-2 : 2e-3;
      EXPECT_LT((there - expected.value.row(row)).norm(), close * (1 + there.norm()))
          << row << ": " << there << "\n"
          << expected.value.row(row);
    }
  });
}

}  // namespace
}  // namespace flexura
