#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/calibrate/rig_problem.h"

namespace flexura {

/// Iteration limits of a descent and treatment of residuals.
struct RigCalibrationConfig {
  int most_iterations = 60;  ///< Largest number of iterations per descent.
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
  /// Covariance of x. Entries are infinite if the observations do not determine a part of x.
  Eigen::MatrixXd covariance;
  double rms = 0;    ///< Root mean square of the residual entries, in their standard deviations.
  double scale = 1;  ///< Scale of the residuals, corrected for the number of fitted variables; sigmas are
                     ///< multiplied by it if it is above 1.
  std::vector<RigOutlier> outliers;  ///< Excluded outliers.
  int iterations = 0, starts = 0;    ///< Iterations of all descents together; number of rough starts tried.
};

/// Estimates the rig that explains the observations best, starting from rough guesses (docs/calibration.md).
/// The result is the minimum of `problem`, whose outliers are set. Equal problems give bit-identical results.
[[nodiscard]] RigCalibration calibrate_rig(RigProblem& problem, const RigCalibrationConfig& config = {});

}  // namespace flexura
