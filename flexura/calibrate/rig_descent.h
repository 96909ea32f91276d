#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/calibrate/rig_problem.h"

namespace flexura {

/// What a descent may move, and how far residuals are believed.
struct RigDescentConfig {
  std::vector<bool> is_free;  ///< By column of x; empty: all.
  int most_iterations = 60;
  double bound = 3;             ///< Residuals count linearly from here on, ...
  bool does_bound_rise = true;  ///< ... or from where most of them are not, if that is further.
};

struct RigDescent {
  Eigen::VectorXd x;
  double cost = 0;  ///< With the bound as configured; infinite where nothing can be seen from the start.
  bool is_settled = false;  ///< No step leads further down, or none by more than nothing.
  int iterations = 0;
};

/// Levenberg and Marquardt's method from `start` down. `problem` is left linearised at the end.
[[nodiscard]] RigDescent descend(RigProblem& problem, const Eigen::VectorXd& start,
                                 const RigDescentConfig& config);

}  // namespace flexura
