#pragma once

#include <Eigen/Core>
#include <cmath>

namespace flexura {

/// Returns x of A x = b, with A symmetric and positive definite (uses the lower triangle). For inner loops:
/// few rows, of a fixed number, and without allocation. Not finite if A is not definite; an infinite diagonal
/// element counts as definite. (Eigen's LLT costs a source nearly two seconds to compile for each fixed
/// size.)
template <int n>
[[nodiscard]] Eigen::Vector<double, n> solve_definite(Eigen::Matrix<double, n, n> A,
                                                      Eigen::Vector<double, n> b) {
  // A becomes L, row by row, and b becomes L^-1 b.
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = A(i, j);
      for (int k = 0; k < j; ++k) sum -= A(i, k) * A(j, k);
      A(i, j) = j < i ? sum / A(j, j) : std::sqrt(sum);
      if (j < i) b[i] -= A(i, j) * b[j];
    }
    b[i] /= A(i, i);
  }
  for (int i = n; i-- > 0;) {
    for (int k = i + 1; k < n; ++k) b[i] -= A(k, i) * b[k];
    b[i] /= A(i, i);
  }
  return b;
}

}  // namespace flexura
