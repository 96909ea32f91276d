#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace flexura {

/// A small linear complementarity problem for x. Each component of x is 0, at least 0, or free, according to
/// its kind. The residual matrix x - rhs is 0 for components that are not 0. It is at least 0 for components
/// that are 0 but could be positive.
struct Complementary {
  enum class Kind { none, at_least_0, free };

  /// Solves by principal pivots: changes one variable at a time between held at 0 and released. Starts from
  /// `held_off` (variables not held at 0), which becomes the final set. Always ends for positive definite
  /// matrices. `rounding`: a smaller component of the residual counts as 0. Returns std::nullopt if no
  /// solution was found or the numbers are not finite.
  [[nodiscard]] std::optional<Eigen::VectorXd> solve(std::vector<char>& held_off, double rounding) const;

  Eigen::MatrixXd matrix;
  Eigen::VectorXd rhs;
  std::vector<Kind> kinds;
};

}  // namespace flexura
