#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod.h"

// Inverse dynamics: the tensions that a motion needs (docs/mechanics.md, "Inverse dynamics and
// identification").
namespace flexura {

/// A rod's motion at a time.
struct RodMotionSample {
  double time = 0;    ///< s
  Eigen::VectorXd q;  ///< The strain modes, as of RodChain.
  Eigen::VectorXd v;  ///< dq/dt
  Eigen::VectorXd a;  ///< dv/dt
};

/// Which tensions are looked for.
struct TensionFitConfig {
  std::vector<double> most = {};  ///< N, one a tendon, each >= 0; empty: as much as is needed.
  /// What effort counts beside what is missing, as a part of what the tendons make: of tensions that make the
  /// same forces it takes those of the least sum of squares, and falsifies others by about as much; > 0.
  double effort = 1e-10;
};

/// Tensions that come nearest to generalized forces.
struct TensionFit {
  std::vector<double> tensions;  ///< N, one a tendon, each from 0 to its most.
  Eigen::VectorXd desired;       ///< The generalized forces that were asked for.
  Eigen::VectorXd missing;       ///< What is left of them: wanted less what the tensions make.
  /// How large that is: the energy that the rod would store under them, J. Forces of wanted energy E that
  /// are missed altogether have the missing energy E.
  double desired_energy = 0, missing_energy = 0;
  /// Whether no other tensions, of whatever sign, make the same forces: the tendons do not depend on each
  /// other.
  bool is_determined = false;

  /// The part of what was wanted that is missing, 0 to 1: the root of these energies' ratio.
  [[nodiscard]] double residual() const;
};

/// The tensions that come nearest to generalized forces `desired` at q: those of the least missing energy f^T
/// K^-1 f / 2, K the rod's stiffness, so that stiff strains count as little as they give. Of many that do,
/// those of least effort. std::invalid_argument: another number of modes or bounds, numbers that are not
/// finite, a bound below 0.
[[nodiscard]] TensionFit nearest_tensions(RodDynamics& dynamics, const Eigen::VectorXd& q,
                                          const Eigen::VectorXd& desired,
                                          const TensionFitConfig& config = {});

/// The tensions of a motion at one time, under loads: nearest_tensions to its needed_forces. Errors likewise.
[[nodiscard]] TensionFit inverse_dynamics(RodDynamics& dynamics, const RodMotionSample& motion,
                                          const RodLoads& loads, const TensionFitConfig& config = {});
/// The same along a motion.
[[nodiscard]] std::vector<TensionFit> inverse_dynamics(RodDynamics& dynamics,
                                                       std::span<const RodMotionSample> motion,
                                                       const RodLoads& loads,
                                                       const TensionFitConfig& config = {});

/// The tensions that hold the rod at rest at q under loads. Errors likewise.
[[nodiscard]] TensionFit gravity_compensation(RodDynamics& dynamics, const Eigen::VectorXd& q,
                                              const RodLoads& loads, const TensionFitConfig& config = {});

/// Gains of a law that follows a motion.
struct ComputedTorqueGains {
  double position = 0;  ///< Kp, 1/s^2
  double velocity = 0;  ///< Kd, 1/s; 2 sqrt(Kp) lets errors fall without a swing.
};

/// The tensions that accelerate a rod at q, v by wanted.a + Kd (wanted.v - v) + Kp (wanted.q - q): where they
/// make all of the forces, the error e of all modes obeys e'' + Kd e' + Kp e = 0. Errors likewise; gains that
/// are not finite.
[[nodiscard]] TensionFit computed_torque(RodDynamics& dynamics, const Eigen::VectorXd& q,
                                         const Eigen::VectorXd& v, const RodMotionSample& desired,
                                         const ComputedTorqueGains& gains, const RodLoads& loads,
                                         const TensionFitConfig& config = {});

}  // namespace flexura
