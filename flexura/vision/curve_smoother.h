#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace flexura {

/// Smooths evenly spaced values y of three channels: minimizes sum w_i |y_i - z_i|^2 + sum strength_i |third
/// difference of z|^2 (E. T. Whittaker, 1923). Values of weight 0 are interpolated. Parabolas are unchanged.
/// The smoothing averages over about 2.5 strength^(1/6) values.
class CurveSmoother {
 public:
  using Values = Eigen::Vector3d;

  /// Replaces `values` by smoothed values; fewer than 4 values are unchanged. Weights and strengths, one per
  /// value, must not be negative, and at least one weight must be above 0. Strength i applies to the third
  /// difference of values i to i + 3.
  void smooth(std::span<Values> values, std::span<const double> weights, std::span<const double> strengths);

 private:
  // Rows of the banded Cholesky factor: the diagonal and three entries beside it.
  std::vector<std::array<double, 4>> factor_;
};

}  // namespace flexura
