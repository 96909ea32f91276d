#pragma once

#include <Eigen/Core>
#include <functional>

namespace flexura {

/// A function R^n -> R^m.
using VectorFunction = std::function<Eigen::VectorXd(const Eigen::VectorXd&)>;

/// A Jacobian computed by finite differences, with its estimated error.
struct NumericalJacobian {
  Eigen::MatrixXd value;  ///< m x n.
  Eigen::MatrixXd error;  ///< Estimated absolute error of each element of `value`, m x n.
};

/// Returns the Jacobian of f at x, computed by central differences and Richardson extrapolation to step 0
/// (Ridders 1982). Tests use this function to check analytic derivatives. `step` > 0, in the units of x, is
/// the first of a decreasing sequence of steps. A good value is a tenth of the distance over which f deviates
/// noticeably from a linear function.
[[nodiscard]] NumericalJacobian numerical_jacobian(const VectorFunction& f, const Eigen::VectorXd& x,
                                                   double step = 0.1);

}  // namespace flexura
