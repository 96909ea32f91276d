#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace flexura {

/// A small linear complementarity problem for x. By its kind each x is 0, at least 0, or free. The residual
/// (matrix x - rhs) is 0 where x is not 0, and at least 0 where x is 0 but could be positive.
struct Complementary {
  enum class Kind { none, at_least_0, free };

  /// Solves by principal pivots: changes one variable at a time between held at 0 and released. Starts from
  /// `held_off` (variables not held at 0), which becomes the final set. Ends for positive definite matrices.
  /// `rounding`: below this a component of matrix x - rhs counts as 0.
  /// Returns std::nullopt if no end was found or the numbers are not finite.
  [[nodiscard]] std::optional<Eigen::VectorXd> solve(std::vector<char>& held_off, double rounding) const;

  Eigen::MatrixXd matrix;
  Eigen::VectorXd rhs;
  std::vector<Kind> kinds;
};

}  // namespace flexura
