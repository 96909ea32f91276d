#pragma once

#include <Eigen/Core>
#include <vector>

namespace flexura {

/// A limit on one variable (an interval) or on two that follow each other (a disk about 0).
struct Bound {
  Eigen::Index at = 0;
  Eigen::Index size = 1;  ///< 1: low <= x <= high; 2: |(x, y)| <= high.
  double low = 0.0;
  double high = 0.0;

  [[nodiscard]] static Bound interval(Eigen::Index at, double low, double high) { return {at, 1, low, high}; }
  [[nodiscard]] static Bound disk(Eigen::Index at, double radius) { return {at, 2, 0.0, radius}; }
};

/// Limits on different variables each.
using Bounds = std::vector<Bound>;

/// Moves x to the nearest point within `bounds`: never outside, not even by rounding.
void project(const Bounds& bounds, Eigen::VectorXd& x);

/// How strongly `gradient` (of what is to be made small) presses x against its bounds: the norm of the part
/// of -gradient that points out at bounds that hold x.
[[nodiscard]] double pressure(const Bounds& bounds, const Eigen::VectorXd& x,
                              const Eigen::VectorXd& gradient);

/// What is left of `gradient` when its parts that press x against its bounds are taken out; zero at a
/// constrained minimum.
void free_gradient(const Bounds& bounds, const Eigen::VectorXd& x, Eigen::VectorXd& gradient);

}  // namespace flexura
