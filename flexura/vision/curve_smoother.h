#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace flexura {

/// Smooths evenly spaced values: the z that minimize sum w_i |y_i - z_i|^2 + sum strength_i |third
/// difference of z|^2 (E. T. Whittaker, 1923), three channels at once. Where weights are 0 it bridges. A
/// parabola stays as it is; the width of what is averaged is about 2.5 strength^(1/6) values.
class CurveSmoother {
 public:
  using Values = Eigen::Vector3d;

  /// `values` become the smooth ones. Fewer than 4 stay as they are. Weights and strengths, one a value, are
  /// not negative, and not all weights 0; strength i is that of the difference of values i to i + 3.
  void smooth(std::span<Values> values, std::span<const double> weights, std::span<const double> strengths);

 private:
  std::vector<std::array<double, 4>> factor_;  // Rows of the banded factor: diagonal and three beside it.
};

}  // namespace flexura
