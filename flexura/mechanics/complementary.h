#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace flexura {

/// A small linear complementarity problem for x. According to its kind, each component of x is 0, at least 0,
/// or free. The residual is matrix * x - rhs. The residual is 0 in free and in positive components. In
/// components of the kind at_least_0 that are 0, the residual is at least 0.
struct Complementary {
  enum class Kind { none, at_least_0, free };

  /// Solves the problem by principal pivots. Each pivot fixes one variable at 0, or releases it. `held_off`:
  /// set of the released variables, initially a guess, finally the set of the solution. The method always
  /// ends for positive definite matrices. `rounding`: smaller components of the residual count as 0. Returns
  /// std::nullopt if no solution was found or the numbers are not finite.
  [[nodiscard]] std::optional<Eigen::VectorXd> solve(std::vector<char>& held_off, double rounding) const;

  Eigen::MatrixXd matrix;
  Eigen::VectorXd rhs;
  std::vector<Kind> kinds;
};

}  // namespace flexura
