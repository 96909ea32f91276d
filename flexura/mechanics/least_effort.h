#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/bounded_least_squares.h"

namespace flexura {

/// The d of least d^T A d / 2 + b^T d with low <= d <= high, for a positive definite A and bounds that
/// include 0. By an active set.
[[nodiscard]] Eigen::VectorXd least_in_box(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                                           const Eigen::VectorXd& low, const Eigen::VectorXd& high);

/// Moves x, where the descent's problem is met and whose r and J the descent has, along its solutions to
/// where |x| is least nearby, within the bounds, intervals from 0 for each variable. x stays a solution.
/// Whether it is such a minimum.
///
/// By stabilized sequential quadratic programming (S. J. Wright 1998), which takes derivatives that depend on
/// each other, with M. J. D. Powell's damped updates of the Lagrangian's second derivative. Each step comes
/// back to the solutions by a descent, and counts if |x| is then less.
bool run_down_to_least(BoundedDescent& descent, Eigen::VectorXd& x);

}  // namespace flexura
