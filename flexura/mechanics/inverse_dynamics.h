#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod.h"

// Inverse dynamics: tensions needed for a motion (docs/mechanics.md, "Inverse dynamics and identification").
namespace flexura {

/// Motion of a rod at one time.
struct RodMotionSample {
  double time = 0;    ///< s
  Eigen::VectorXd q;  ///< Strain modes, as in RodChain.
  Eigen::VectorXd v;  ///< dq/dt
  Eigen::VectorXd a;  ///< dv/dt
};

/// Settings of the tension fit.
struct TensionFitConfig {
  std::vector<double> most = {};  ///< Maxima, N, one per tendon, each >= 0; empty: unbounded.
  /// Weight of the effort, the sum of squared tensions, relative to the missing forces; > 0. This weight
  /// selects the tensions of least effort among tensions that apply equal forces. If the tensions are unique,
  /// the weight changes them by a relative error of about this weight.
  double effort = 1e-10;
};

/// Tensions that come nearest to target generalized forces.
struct TensionFit {
  std::vector<double> tensions;  ///< Tensions, N, one per tendon, each from 0 to its maximum.
  Eigen::VectorXd desired;       ///< Target generalized forces.
  Eigen::VectorXd missing;       ///< Remaining forces: target forces minus the forces of the tensions.
  /// Elastic energies that the rod would store under the target forces, and under the missing forces, J. If
  /// no tension reduces the missing forces, both energies are equal.
  double desired_energy = 0, missing_energy = 0;
  /// Whether the tensions would be unique without bounds. The tensions are unique if the forces of the
  /// tendons are linearly independent.
  bool is_determined = false;

  /// Returns the missing part of the target, 0 to 1: the square root of missing_energy / desired_energy.
  [[nodiscard]] double residual() const;
};

/// Returns the tensions that come nearest to the generalized forces `desired` at q. These tensions minimise
/// the missing energy f^T K^-1 f / 2, where f are the missing forces and K is the rod's stiffness. So forces
/// on stiff strains have little weight. Among several minima, the one with least effort is returned. Throws
/// std::invalid_argument for lists of wrong length, numbers that are not finite, or a bound below 0.
[[nodiscard]] TensionFit nearest_tensions(RodDynamics& dynamics, const Eigen::VectorXd& q,
                                          const Eigen::VectorXd& desired,
                                          const TensionFitConfig& config = {});

/// Returns the tensions of a motion at one time under loads: the nearest_tensions to the needed_forces.
/// Throws as nearest_tensions.
[[nodiscard]] TensionFit inverse_dynamics(RodDynamics& dynamics, const RodMotionSample& motion,
                                          const RodLoads& loads, const TensionFitConfig& config = {});
/// Returns the tensions along a motion.
[[nodiscard]] std::vector<TensionFit> inverse_dynamics(RodDynamics& dynamics,
                                                       std::span<const RodMotionSample> motion,
                                                       const RodLoads& loads,
                                                       const TensionFitConfig& config = {});

/// Returns the tensions that hold the rod at rest at q under loads. Throws as nearest_tensions.
[[nodiscard]] TensionFit gravity_compensation(RodDynamics& dynamics, const Eigen::VectorXd& q,
                                              const RodLoads& loads, const TensionFitConfig& config = {});

/// Gains of computed torque.
struct ComputedTorqueGains {
  double position = 0;  ///< Kp, 1/s^2
  double velocity = 0;  ///< Kd, 1/s; 2 sqrt(Kp) is critical damping.
};

/// Returns the tensions that accelerate a rod at q, v by desired.a + Kd (desired.v - v) + Kp (desired.q - q).
/// If tensions can apply the needed forces exactly, the error e of each mode obeys e'' + Kd e' + Kp e = 0.
/// Throws the exceptions of nearest_tensions, and std::invalid_argument for gains that are not finite.
[[nodiscard]] TensionFit computed_torque(RodDynamics& dynamics, const Eigen::VectorXd& q,
                                         const Eigen::VectorXd& v, const RodMotionSample& desired,
                                         const ComputedTorqueGains& gains, const RodLoads& loads,
                                         const TensionFitConfig& config = {});

}  // namespace flexura
