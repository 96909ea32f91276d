#pragma once

#include <Eigen/Core>
#include <vector>

namespace flexura {

/// A limit on one variable (an interval) or on two consecutive ones (a disk about 0).
struct Bound {
  Eigen::Index at = 0;
  Eigen::Index size = 1;  ///< 1: low <= x <= high; 2: |(x, y)| <= high.
  double low = 0.0;
  double high = 0.0;

  [[nodiscard]] static Bound interval(Eigen::Index at, double low, double high) { return {at, 1, low, high}; }
  [[nodiscard]] static Bound disk(Eigen::Index at, double radius) { return {at, 2, 0.0, radius}; }
};

/// Limits on different variables.
using Bounds = std::vector<Bound>;

/// Moves x to the nearest point within `bounds`, never outside, not even by rounding.
void project(const Bounds& bounds, Eigen::VectorXd& x);

/// Returns how strongly `gradient` (of the function to minimise) presses x against its bounds. This is the
/// norm of the outward part of -gradient at bounds that hold x.
[[nodiscard]] double pressure(const Bounds& bounds, const Eigen::VectorXd& x,
                              const Eigen::VectorXd& gradient);

/// Removes the parts of `gradient` that press x against its bounds; the rest is zero at a constrained
/// minimum.
void free_gradient(const Bounds& bounds, const Eigen::VectorXd& x, Eigen::VectorXd& gradient);

}  // namespace flexura
