#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace flexura {

/// Smooths a sequence y of evenly spaced vectors (E. T. Whittaker, 1923). The result z minimizes
/// sum_i w_i |y_i - z_i|^2 + sum_i strength_i |z_(i+3) - 3 z_(i+2) + 3 z_(i+1) - z_i|^2. Elements with weight
/// 0 are interpolated. Parabolas remain unchanged. An element of the result is an average over about 2.5
/// strength^(1/6) elements of y.
class CurveSmoother {
 public:
  using Values = Eigen::Vector3d;

  /// Replaces `values` by smoothed values. Fewer than 4 values remain unchanged. `weights` and `strengths`
  /// have as many elements as `values`. None may be negative, and at least one weight must be positive.
  void smooth(std::span<Values> values, std::span<const double> weights, std::span<const double> strengths);

 private:
  // Rows of the banded Cholesky factor: the diagonal and three entries beside it.
  std::vector<std::array<double, 4>> factor_;
};

}  // namespace flexura
