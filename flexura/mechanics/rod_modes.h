#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/mechanics/dynamics.h"

namespace flexura {

/// Natural modes of a rod around an equilibrium.
struct RodModes {
  /// Eigenvalues of A of x = (q, v), 1/s, sorted by absolute value; in pairs the one with negative imaginary
  /// part is first.
  Eigen::VectorXcd eigenvalues;
  /// For each pair, in that order: |eigenvalue| / 2 pi, Hz, and -real part / |eigenvalue|. Overdamped modes
  /// are not in these lists.
  std::vector<double> frequencies, damping_ratios;
};

/// Returns the modes from derivatives at rest (RodDynamics::slopes). They come from the shifted inverse of A.
/// So slow modes are exact to rounding although held tendons are very stiff. Fast ones have a relative error
/// of about 1e-16 times the square of their ratio to the slow ones. Not finite where that inverse does not
/// exist, for a shift in general.
[[nodiscard]] RodModes rod_modes(const RodDynamicsSlopes& at_rest);

}  // namespace flexura
