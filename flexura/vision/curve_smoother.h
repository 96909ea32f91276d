#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace flexura {

/// Smooths evenly spaced values, three channels at once: minimises sum w_i |y_i - z_i|^2 + sum strength_i
/// |third difference of z|^2 (E. T. Whittaker, 1923). It bridges values of weight 0 and leaves parabolas
/// unchanged. It averages over about 2.5 strength^(1/6) values.
class CurveSmoother {
 public:
  using Values = Eigen::Vector3d;

  /// Replaces `values` by the smooth ones; fewer than 4 stay unchanged. Weights and strengths, one per value,
  /// must not be negative, and not all weights 0. Strength i is that of the difference of values i to i + 3.
  void smooth(std::span<Values> values, std::span<const double> weights, std::span<const double> strengths);

 private:
  // Rows of the banded factor: the diagonal and three entries beside it.
  std::vector<std::array<double, 4>> factor_;
};

}  // namespace flexura
