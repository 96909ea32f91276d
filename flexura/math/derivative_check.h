#pragma once

#include <Eigen/Core>
#include <functional>

namespace flexura {

/// f: R^n -> R^m.
using VectorFunction = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// A derivative by differences and its estimated error.
struct NumericalJacobian {
  Eigen::MatrixXd value;  ///< m x n.
  Eigen::MatrixXd error;  ///< m x n: estimated absolute error of each element.
};

/// Returns the Jacobian of f at x by central differences, extrapolated to step 0 (Richardson; Ridders 1982).
/// For checking analytic derivatives. `step` > 0 is the first of a decreasing sequence of steps, in the units
/// of x: about a tenth of the distance over which f curves.
[[nodiscard]] NumericalJacobian numerical_jacobian(const VectorFunction& f, const Eigen::VectorXd& x,
                                                   double step = 0.1);

}  // namespace flexura
