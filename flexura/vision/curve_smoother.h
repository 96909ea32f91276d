#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace flexura {

/// Smooths evenly spaced values y of three channels: minimizes sum w_i |y_i - z_i|^2 + sum strength_i |third
/// difference of z|^2 (E. T. Whittaker, 1923). Values with weight 0 are interpolated. Parabolas remain
/// unchanged. The smoothing averages over about 2.5 strength^(1/6) values.
class CurveSmoother {
 public:
  using Values = Eigen::Vector3d;

  /// Replaces `values` by smoothed values. Fewer than 4 values remain unchanged. There must be one weight and
  /// one strength per value, none negative, and at least one weight above 0. Strength i applies to the third
  /// difference of values i to i + 3.
  void smooth(std::span<Values> values, std::span<const double> weights, std::span<const double> strengths);

 private:
  // Rows of the banded Cholesky factor: the diagonal and three entries beside it.
  std::vector<std::array<double, 4>> factor_;
};

}  // namespace flexura
