#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/calibrate/rig_problem.h"

namespace flexura {

/// Settings of a descent: free variables, number of iterations and treatment of large residuals.
struct RigDescentConfig {
  std::vector<bool> is_free;  ///< Whether each variable of x is free; empty: all are free.
  int most_iterations = 60;
  double bound = 3;  ///< Size of a residual, in standard deviations, beyond which its cost is linear.
  /// Whether the bound is raised to the size of most residuals if they are larger.
  bool does_bound_rise = true;
};

struct RigDescent {
  Eigen::VectorXd x;
  /// Cost with the configured bound; infinite if the observed points would be invisible for the rig at the
  /// start.
  double cost = 0;
  bool is_settled = false;  ///< Whether the descent converged: no step lowers the cost noticeably.
  int iterations = 0;
};

/// Minimises the cost by the Levenberg-Marquardt method, starting at `start`. Afterwards `problem` is
/// linearised at the result.
[[nodiscard]] RigDescent descend(RigProblem& problem, const Eigen::VectorXd& start,
                                 const RigDescentConfig& config);

}  // namespace flexura
