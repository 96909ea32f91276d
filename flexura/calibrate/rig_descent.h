#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/calibrate/rig_problem.h"

namespace flexura {

/// Free variables of a descent and its bound on residuals.
struct RigDescentConfig {
  std::vector<bool> is_free;  ///< Free columns of x; empty: all are free.
  int most_iterations = 60;
  double bound = 3;             ///< Residuals count linearly beyond this ...
  bool does_bound_rise = true;  ///< ... or beyond the size of most residuals, if that is larger.
};

struct RigDescent {
  Eigen::VectorXd x;
  double cost = 0;  ///< Cost with the configured bound; infinite if nothing is visible from the start.
  bool is_settled = false;  ///< Whether no step lowers the cost noticeably.
  int iterations = 0;
};

/// Minimises by the Levenberg-Marquardt method from `start`. Leaves `problem` linearised at the result.
[[nodiscard]] RigDescent descend(RigProblem& problem, const Eigen::VectorXd& start,
                                 const RigDescentConfig& config);

}  // namespace flexura
