#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/calibrate/rig_problem.h"

namespace flexura {

/// Settings of a calibration: limit of iterations, and treatment of residuals.
struct RigCalibrationConfig {
  int most_iterations = 60;  ///< Largest number of iterations of each descent.
  double linear_beyond = 3;  ///< Size of a residual, in standard deviations, beyond which its cost is linear.
  double outlier_beyond =
      6;  ///< Size of a residual, in standard deviations, beyond which it is excluded as an outlier.
  double most_rms = 3;  ///< A fit with a larger root mean square of the residuals is rejected.
};

/// Result of a calibration.
struct RigCalibration {
  bool is_found = false;
  std::string reason;  ///< Why the calibration failed.
  RigModel model;
  std::vector<ArmState> poses;     ///< Estimated arm poses.
  std::vector<RigStance> stances;  ///< Estimated camera stances.
  Eigen::VectorXd x;               ///< Values of the problem's variables.
  /// Covariance of x. Entries of variables that the observations do not determine are infinite.
  Eigen::MatrixXd covariance;
  double rms = 0;  ///< Root mean square of the residual entries, in their standard deviations.
  /// Scale of the residuals, corrected for the number of fitted variables. If it is above 1, sigmas are
  /// multiplied by it.
  double scale = 1;
  std::vector<RigOutlier> outliers;  ///< Excluded outliers.
  int iterations = 0, starts = 0;    ///< Total iterations of all descents, and number of rough starts.
};

/// Estimates the rig that explains the observations best, starting from rough guesses (docs/calibration.md).
/// The result is the minimum of the cost of `problem`. Sets the outliers of `problem`. Equal problems give
/// bit-identical results.
[[nodiscard]] RigCalibration calibrate_rig(RigProblem& problem, const RigCalibrationConfig& config = {});

}  // namespace flexura
