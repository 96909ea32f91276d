#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/mechanics/dynamics.h"

namespace flexura {

/// Natural modes of a rod around an equilibrium.
struct RodModes {
  /// Eigenvalues of A in x' = A x with x = (q, v), 1/s, sorted by absolute value. In a conjugate pair, the
  /// eigenvalue with negative imaginary part is first.
  Eigen::VectorXcd eigenvalues;
  /// Frequency |eigenvalue| / (2 pi), Hz, and damping ratio -(real part) / |eigenvalue| of each conjugate
  /// pair, in the order of the eigenvalues. Overdamped modes have no pair and are omitted.
  std::vector<double> frequencies, damping_ratios;
};

/// Returns the modes from derivatives at rest (RodDynamics::slopes). The modes are computed from a shifted
/// inverse of A, so that slow modes are accurate to rounding although held tendons are very stiff. A fast
/// mode has a relative error of about 1e-16 times the square of its frequency relative to the slow modes.
/// Results are not finite if the shifted inverse does not exist.
[[nodiscard]] RodModes rod_modes(const RodDynamicsSlopes& at_rest);

}  // namespace flexura
