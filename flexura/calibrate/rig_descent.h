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
  bool does_bound_rise = true;  ///< Whether the bound rises to the size of most residuals if that is larger.
};

struct RigDescent {
  Eigen::VectorXd x;
  double cost = 0;  ///< Cost with the configured bound; infinite if the rig at the start would not show the
                    ///< observations.
  bool is_settled = false;  ///< Whether no step lowers the cost noticeably.
  int iterations = 0;
};

/// Minimises by the Levenberg-Marquardt method from `start`. Leaves `problem` linearised at the result.
[[nodiscard]] RigDescent descend(RigProblem& problem, const Eigen::VectorXd& start,
                                 const RigDescentConfig& config);

}  // namespace flexura
