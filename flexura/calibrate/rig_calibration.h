#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "flexura/calibrate/rig_problem.h"

namespace flexura {

/// How long a descent may take, and which residuals it believes.
struct RigCalibrationConfig {
  int most_iterations = 60;   ///< Of each descent.
  double linear_beyond = 3;   ///< Residuals count linearly from here on, in standard deviations.
  double doubted_beyond = 6;  ///< And not at all from here on.
  double most_rms = 3;        ///< Fits whose residuals are larger than this explain nothing.
};

/// A rig as it was found.
struct RigCalibration {
  bool is_found = false;
  std::string reason;  ///< Why it is not.
  RigModel model;
  std::vector<ArmState> poses;     ///< How the arm stood.
  std::vector<RigStance> stances;  ///< How the cameras stood.
  Eigen::VectorXd x;               ///< Of the problem's variables.
  Eigen::MatrixXd covariance;  ///< Of x. Infinite entries: the observations leave part of x without bound.
  double rms = 0;              ///< Of the residuals' entries, in their own standard deviations.
  double scale = 1;  ///< Of the residuals, for what was fitted; sigmas are larger by it where it is above 1.
  std::vector<RigDoubt> doubts;    ///< What was taken for something else's.
  int iterations = 0, starts = 0;  ///< Of all descents together; rough starts tried.
};

/// The rig that explains the observations best, from rough guesses on (docs/calibration.md): the least of
/// `problem`, whose doubts it sets. The same problem gives the same bits.
[[nodiscard]] RigCalibration calibrate_rig(RigProblem& problem, const RigCalibrationConfig& config = {});

}  // namespace flexura
