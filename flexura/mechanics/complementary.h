#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace flexura {

/// A small linear complementarity problem: x of which each is 0, or 0 or more, or anything, with
/// (matrix x - rhs) 0 where x is not, and at least 0 where x could be more than 0 and is not.
struct Complementary {
  enum class Kind { none, at_least_0, free };

  /// By changing one at a time what is held at 0 (principal pivots), from `held_off`, where what is not 0 is
  /// not held, which it becomes: for positive definite matrices an end is found. `rounding`: what counts as 0
  /// of matrix x - rhs.
  /// None: no end was found, or the numbers are not finite.
  [[nodiscard]] std::optional<Eigen::VectorXd> solve(std::vector<char>& held_off, double rounding) const;

  Eigen::MatrixXd matrix;
  Eigen::VectorXd rhs;
  std::vector<Kind> kinds;
};

}  // namespace flexura
