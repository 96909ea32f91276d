#include "flexura/vision/curve_smoother.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace flexura {
namespace {

// Third differences.
constexpr std::array<double, 4> difference = {-1, 3, -3, 1};

}  // namespace

void CurveSmoother::smooth(std::span<Values> values, std::span<const double> weights,
                           std::span<const double> strengths) {
  const std::size_t n = values.size();
  if (n < 4) return;
  factor_.assign(n, {0, 0, 0, 0});
  for (std::size_t i = 0; i < n; ++i) {
    // A minimum weight keeps the equations solvable where a long stretch is bridged.
    const double weight = std::max(weights[i], 1e-9);
    factor_[i][0] = weight;
    values[i] *= weight;
  }
  for (std::size_t i = 0; i + 3 < n; ++i)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a; b < 4; ++b)
        factor_[i + a][b - a] += strengths[i] * difference[a] * difference[b];
  // L D L^T in place: factor_[i][k] becomes L(i + k, i), factor_[i][0] D(i).
  for (std::size_t i = 0; i < n; ++i) {
    const std::array<double, 4> row = factor_[i];
    const double inverse = 1 / row[0];
    for (std::size_t k = 1; k < 4 && i + k < n; ++k) {
      const double share = row[k] * inverse;
      for (std::size_t j = k; j < 4 && i + j < n; ++j) factor_[i + k][j - k] -= share * row[j];
      values[i + k] -= share * values[i];
      factor_[i][k] = share;
    }
    factor_[i][0] = inverse;
  }
  for (std::size_t i = n; i-- > 0;) {
    values[i] *= factor_[i][0];
    for (std::size_t k = 1; k < 4 && i + k < n; ++k) values[i] -= factor_[i][k] * values[i + k];
  }
}

}  // namespace flexura
