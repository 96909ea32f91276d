#pragma once

#include <Eigen/Core>
#include <cmath>

namespace flexura {

/// Solves A x = b for a symmetric positive definite A, of which only the lower triangle is used. This
/// function is meant for inner loops with few unknowns: the size n is fixed, and no memory is allocated. The
/// result is not finite if A is not positive definite; an infinite diagonal element counts as positive
/// definite. (Eigen's LLT would add nearly two seconds of compile time for each fixed size.)
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
