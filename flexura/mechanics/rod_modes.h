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

/// Those of derivatives at rest (RodDynamics::slopes). Slow ones are exact to rounding although tendons that
/// are held are very stiff: they come from the inverse of A, shifted. Of fast ones about 1e-16 times the
/// square of the ratio to the slow is wrong. Not finite where that inverse does not exist, for a shift in
/// general.
[[nodiscard]] RodModes rod_modes(const RodDynamicsSlopes& at_rest);

}  // namespace flexura
