#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "flexura/calibrate/rig_aim.h"
#include "flexura/calibrate/rig_calibration.h"
#include "flexura/calibrate/rig_quantities.h"
#include "flexura/math/derivative_check.h"
#include "tests/support/rig_trials.h"

namespace flexura {

/// Error and standard deviation of an estimated quantity.
struct RigFigure {
  double error = 0, sigma = 0;
};

/// Key results of a calibration, at the last axis positions of each camera in the trial.
struct RigFigures {
  RigFigure angle;                 ///< Angle between the optical axes, rad.
  RigFigure zoom_ratio;            ///< Relative.
  std::array<RigFigure, 2> focal;  ///< Relative.
  double aim = 0;                  ///< Larger error of the axes' distances from the arm's middle, m.
};

inline RigFigures figures_of(const RigTrial& trial, const RigProblem& problem, const RigCalibration& found) {
  const RigVariables& variables = problem.variables();
  // The markers lie on the nominal arm; the pictures are left out.
  const RigVariables truth(trial.truth(), problem.prior(), {trial.seen().poses, trial.seen().stances, {}});
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(truth.count());
  const std::size_t last = trial.seen().stances.size() - 1;
  const std::array<std::size_t, 2> stances = {last - 1, last};
  std::vector<OpticalAxis> is, should;
  for (const std::size_t stance : stances) {
    is.push_back(optical_axis(variables, found.x, observed_stance(variables, stance)));
    should.push_back(optical_axis(truth, none, {trial.stance(stance), {}}));
  }
  const Eigen::Vector3d middle = arm_middle(trial.truth(), trial.seen().poses.back());
  const auto figure = [&](const RigQuantity& a, const RigQuantity& b) {
    return RigFigure{a.value - b.value, a.sigma(found.covariance)};
  };
  RigFigures figures;
  figures.angle = figure(axes_angle(is[0], is[1]), axes_angle(should[0], should[1]));
  figures.zoom_ratio =
      figure(log_zoom_ratio(is[0], is[1], middle), log_zoom_ratio(should[0], should[1], middle));
  for (std::size_t i = 0; i < 2; ++i) {
    figures.focal[i] = figure(log_focal(is[i]), log_focal(should[i]));
    const auto a = aim_errors(is[i], middle), b = aim_errors(should[i], middle);
    figures.aim = std::max(figures.aim, std::hypot(a[0].value - b[0].value, a[1].value - b[1].value));
  }
  return figures;
}

/// Returns the derivatives of one picture's rows at x with respect to its own variables, by finite
/// differences.
inline NumericalJacobian row_differences(RigProblem& problem, const Eigen::VectorXd& x, std::size_t image,
                                         double step) {
  EXPECT_TRUE(problem.linearise(x));
  const std::vector<Eigen::Index> columns = problem.rows()[image].columns;
  const auto residuals = [&](const Eigen::VectorXd& part) -> Eigen::VectorXd {
    Eigen::VectorXd there = x;
    for (std::size_t i = 0; i < columns.size(); ++i) there[columns[i]] += part[static_cast<Eigen::Index>(i)];
    EXPECT_TRUE(problem.linearise(there));
    return problem.rows()[image].residuals;
  };
  return numerical_jacobian(residuals, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(columns.size())),
                            step);
}

}  // namespace flexura
