#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/bounded_least_squares.h"

namespace flexura {

/// Returns the d that minimises d^T A d / 2 + b^T d with low <= d <= high, by an active set method. A is
/// positive definite, and the bounds include 0.
[[nodiscard]] Eigen::VectorXd least_in_box(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                           const Eigen::VectorXd& low, const Eigen::VectorXd& high);

/// Moves x along the solutions of the descent's problem to a nearby minimum of |x| within the bounds. The
/// lower bound of each variable is 0. Initially x must be a solution, and `descent` must have r and J at x.
/// Finally x is also a solution. Returns whether the final x is a minimum of |x|.
///
/// Stabilized sequential quadratic programming (Wright 1998), which handles dependent constraints, with
/// Powell's damped updates of the Lagrangian's second derivative. Each step ends with a descent to a
/// solution. The step is accepted if |x| has decreased.
bool run_down_to_least(BoundedDescent& descent, Eigen::VectorXd& x);

}  // namespace flexura
