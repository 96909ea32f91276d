#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/mechanics/rod.h"

// Identification of a rod's stiffness, viscosity, mass and tendon friction from its motion
// (docs/mechanics.md, "Inverse dynamics and identification").
namespace flexura {

/// A parameter to estimate. A rod's equations of motion are linear in all parameters except friction.
struct RodParameter {
  enum class Kind {
    shear,  ///< Factor on the rod's shear stiffness. The next three are factors on theirs.
    stretch,
    bends,  ///< In both directions.
    twist,
    stiffness,  ///< All four together: Young's modulus, for a known Poisson's ratio.
    damping,   ///< Damping time, s: damping is this times the rod's stiffness, in place of the rod's damping.
    mass,      ///< Factor on the mass of the whole rod: inertia and weight.
    friction,  ///< Friction coefficient of all tendons, or of those that end at the section.
  };
  Kind kind = Kind::bends;
  std::optional<std::size_t> section = {};  ///< Default: all sections together. Must be omitted for a mass.
};

/// Measurement of a rod at one time.
struct RodMotionRecordSample {
  double time = 0;                        ///< s, above that of the sample before.
  Eigen::VectorXd q;                      ///< Strain modes, as in RodChain.
  std::optional<Eigen::VectorXd> v = {};  ///< dq/dt, in all samples or in none; then by differences of q.
  std::vector<double> tensions = {};      ///< N, one a tendon, each >= 0; empty: zero.
  /// Covariance of the errors of q, modes x modes, in all samples or in none; replaces
  /// RodMotionRecord::q_noise. Symmetric, positive definite.
  Eigen::MatrixXd q_covariance = {};
};

/// Recorded motion of a rod.
struct RodMotionRecord {
  std::vector<RodMotionRecordSample>
      samples;  ///< At least 20. A jump of tensions counts as half-way between two.
  RodLoads loads = {};
  /// Standard deviations of the independent errors of each mode and of its rate. Both empty: unknown and
  /// small.
  Eigen::VectorXd q_noise = {}, v_noise = {};
};

/// Settings of the identification.
struct IdentificationConfig {
  /// Duration of the window over which each equation averages, s. About the most informative period. 0: an
  /// eighth of the record.
  double window = 0;
};

/// Result of the identification.
struct Identification {
  Eigen::VectorXd values;      ///< Parameters in their order; unobservable ones have the rod's value.
  Eigen::VectorXd sigma;       ///< Their standard deviations; infinite if not observable.
  Eigen::MatrixXd covariance;  ///< Of observable parameters; other rows and columns are 0.
  std::vector<char> is_observable;
  /// With known noise: sum of squared residuals in standard deviations over the degrees of freedom, about 1
  /// if the model fits. With unknown noise 1.
  double misfit = 0;
  int equations = 0;  ///< Number of scalar equations.
  /// With friction: the last iteration changed values by less than a hundredth of their standard deviation,
  /// or a millionth. Without friction always true.
  bool converged = true;
};

/// Estimates the parameters that fit a record best, by linear least squares of the equations of motion. Each
/// equation of a mode is multiplied by a smooth bump in time and integrated by parts over a window (weak
/// form: M. Shinbrot 1957). So no acceleration is needed. With known noise the equations are weighted by
/// their covariance, propagated from the record to first order. The bias from noise of q and v in the
/// coefficients is removed. With friction the equations are linearised at the last values until these
/// converge (C. F. Gauss, I. Newton), from the rod's friction first, then from other coefficients. If the
/// friction is not observable from any of them, it keeps the rod's value. Throws std::invalid_argument for an
/// invalid rod, overlapping or no parameters, or samples that do not fit.
[[nodiscard]] Identification identify(const Rod& rod, const std::vector<RodParameter>& parameters,
                                      const RodMotionRecord& record, const IdentificationConfig& config = {});

}  // namespace flexura
