#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/mechanics/dynamics.h"

namespace flexura {

/// How a rod swings around where it is at rest.
struct RodModes {
  /// Of A of x = (q, v), as many as x: by growing amount, of pairs that with the negative imaginary part
  /// first, 1/s.
  Eigen::VectorXcd eigenvalues;
  /// Of each pair, in that order: |eigenvalue| / 2 pi, Hz, and - real part / |eigenvalue|. What falls without
  /// a swing has none.
  std::vector<double> frequencies, damping_ratios;
};

/// Those of derivatives at rest (RodDynamics::slopes). The slow ones are exact to rounding: they come from
/// the inverse of A, where there is one, for tendons that are held are very stiff. Fast ones are to about
/// 1e-16 times the square of their ratio to the slowest.
[[nodiscard]] RodModes rod_modes(const RodDynamicsSlopes& at_rest);

}  // namespace flexura
