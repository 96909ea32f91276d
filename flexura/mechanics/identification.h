#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/mechanics/rod.h"

// Identification of a rod's stiffness, viscosity, mass and tendon friction from its motion
// (docs/mechanics.md, "Inverse dynamics and identification").
namespace flexura {

/// A parameter to estimate. A rod's equations of motion are linear in all parameters except friction.
struct RodParameter {
  enum class Kind {
    shear,    ///< Factor on the rod's shear stiffness.
    stretch,  ///< Factor on the stretch stiffness.
    bends,    ///< Factor on the bending stiffness in both directions.
    twist,    ///< Factor on the twist stiffness.
    /// Factor on all four stiffnesses. This parameter determines Young's modulus if Poisson's ratio is known.
    stiffness,
    /// Damping time, s. The damping is this time times the rod's stiffness, and replaces the rod's own
    /// damping.
    damping,
    mass,      ///< Factor on the mass of the whole rod: inertia and weight.
    friction,  ///< Friction coefficient of all tendons, or of the tendons that end at the section.
  };
  Kind kind = Kind::bends;
  std::optional<std::size_t> section =
      {};  ///< Default: all sections together. The section must be omitted for a mass.
};

/// Measurement of a rod at one time.
struct RodMotionRecordSample {
  double time = 0;    ///< Time, s; later than in the previous sample.
  Eigen::VectorXd q;  ///< Strain modes, as in RodChain.
  /// dq/dt, in all samples or in none. If missing, the rates are computed from differences of q.
  std::optional<Eigen::VectorXd> v = {};
  std::vector<double> tensions = {};  ///< Tensions, N, one per tendon, each >= 0; empty: zero.
  /// Covariance of the errors of q, modes x modes, in all samples or in none; replaces
  /// RodMotionRecord::q_noise. Symmetric, positive definite.
  Eigen::MatrixXd q_covariance = {};
};

/// Recorded motion of a rod.
struct RodMotionRecord {
  /// At least 20. If the tensions jump between two samples, the jump is assumed to be half-way between these
  /// samples.
  std::vector<RodMotionRecordSample> samples;
  RodLoads loads = {};
  /// Standard deviations of the independent errors of each mode and of its rate. If both lists are empty, the
  /// errors are unknown and small.
  Eigen::VectorXd q_noise = {}, v_noise = {};
};

/// Settings of the identification.
struct IdentificationConfig {
  /// Duration of the window over which each equation is averaged, s. A good choice is the period of the most
  /// informative motion. 0: an eighth of the record.
  double window = 0;
};

/// Result of the identification.
struct Identification {
  /// Estimates, in the order of the parameters. Unobservable parameters have the given rod's value.
  Eigen::VectorXd values;
  /// Standard deviations of the estimates; infinite for unobservable parameters.
  Eigen::VectorXd sigma;
  Eigen::MatrixXd covariance;  ///< Covariance of the observable parameters; other rows and columns are 0.
  std::vector<char> is_observable;
  /// If the noise is known: sum of squared residuals, each in standard deviations, divided by the degrees of
  /// freedom. The misfit is about 1 if the model fits. With unknown noise: 1.
  double misfit = 0;
  int equations = 0;  ///< Number of scalar equations.
  /// Whether the last iteration changed friction coefficients by less than a hundredth of their standard
  /// deviation, or 1e-6. Always true without friction.
  bool converged = true;
};

/// Estimates the parameters that fit a record best, by linear least squares of the equations of motion. Each
/// equation of a mode is multiplied by a smooth bump in time and integrated by parts over a window (weak
/// form: Shinbrot 1957). So the equations contain no accelerations. With known noise the equations are
/// weighted by their covariance, propagated from the record to first order. Noise of q and v in the
/// equations' coefficients causes a bias, which is removed. With friction, the equations are linearised
/// repeatedly at the last estimate until the estimate converges (Gauss-Newton method). The iteration starts
/// from the rod's friction coefficients and, if necessary, from others. If the friction is observable from
/// none of these starts, the result has the rod's value. Throws std::invalid_argument for an invalid rod, no
/// parameters, overlapping parameters, or samples that do not fit the rod. `progress`, if any, follows the
/// iterations.
[[nodiscard]] Identification identify(const Rod& rod, const std::vector<RodParameter>& parameters,
                                      const RodMotionRecord& record, const IdentificationConfig& config = {},
                                      Progress* progress = nullptr);

}  // namespace flexura
