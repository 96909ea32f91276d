#pragma once

#include <Eigen/Core>
#include <vector>

namespace flexura {

/// A limit on one variable (an interval), or on two consecutive variables (a disk around 0).
struct Bound {
  Eigen::Index at = 0;    ///< Index of the first variable.
  Eigen::Index size = 1;  ///< 1: low <= x <= high; 2: |(x, y)| <= high.
  double low = 0.0;
  double high = 0.0;

  [[nodiscard]] static Bound interval(Eigen::Index at, double low, double high) { return {at, 1, low, high}; }
  [[nodiscard]] static Bound disk(Eigen::Index at, double radius) { return {at, 2, 0.0, radius}; }
};

/// Limits on variables; each variable has at most one limit.
using Bounds = std::vector<Bound>;

/// Moves x to the nearest point within `bounds`. The result is within the bounds even with rounding errors.
void project(const Bounds& bounds, Eigen::VectorXd& x);

/// Returns the norm of the part of -gradient that points out of active bounds at x. `gradient`: gradient of
/// the function to minimise.
[[nodiscard]] double pressure(const Bounds& bounds, const Eigen::VectorXd& x,
                              const Eigen::VectorXd& gradient);

/// Removes the parts of `gradient` for which -gradient points out of active bounds at x. At a constrained
/// minimum, the remaining gradient is zero.
void free_gradient(const Bounds& bounds, const Eigen::VectorXd& x, Eigen::VectorXd& gradient);

}  // namespace flexura
