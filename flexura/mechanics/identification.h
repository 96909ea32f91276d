#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/mechanics/rod.h"

// Identification: a rod's stiffness, viscosity and mass by how it moved (docs/mechanics.md, "Inverse dynamics
// and identification").
namespace flexura {

/// A number that is looked for. Rods' equations of motion are linear in all of them but friction.
struct RodParameter {
  enum class Kind {
    shear,  ///< A factor on what the rod says of its stiffness against shear, as the next three.
    stretch,
    bends,  ///< Of both directions.
    twist,
    stiffness,  ///< These four together: Young's modulus, of a material whose Poisson's ratio is known.
    damping,  ///< s: the damping is this times the stiffness that the rod says, instead of what the rod says.
    mass,     ///< A factor on the mass of all of the rod, inertia and weight.
    friction,  ///< The coefficient of friction of tendons: of all, or of those that end at the section.
  };
  Kind kind = Kind::bends;
  std::optional<std::size_t> section = {};  ///< Left out: of all sections together. Of a mass left out.
};

/// What was measured of a rod at a time.
struct RodMotionRecordSample {
  double time = 0;                        ///< s, above that of the one before.
  Eigen::VectorXd q;                      ///< The strain modes, as of RodChain.
  std::optional<Eigen::VectorXd> v = {};  ///< dq/dt; of all samples or of none: then by differences of q.
  std::vector<double> tensions = {};      ///< N, one a tendon, each >= 0; empty: none pulls.
  /// Of the errors of q, modes x modes, where they depend on each other: of all samples or of none, and
  /// instead of RodMotionRecord::q_noise. Symmetric, positive definite.
  Eigen::MatrixXd q_covariance = {};
};

/// How a rod moved.
struct RodMotionRecord {
  std::vector<RodMotionRecordSample>
      samples;  ///< At least 20. A jump of tensions counts as half-way between two.
  RodLoads loads = {};
  /// Standard deviations of each mode's errors, and of its rate's, which are independent. Both empty: not
  /// known, and small.
  Eigen::VectorXd q_noise = {}, v_noise = {};
};

/// How a record is looked at.
struct IdentificationConfig {
  /// s: how long a piece of the record each equation averages. About the period of what tells most. 0: an
  /// eighth of the record.
  double window = 0;
};

/// What a record tells.
struct Identification {
  Eigen::VectorXd
      values;  ///< Of the parameters, in their order. Of what is not observable, what the rod says.
  Eigen::VectorXd sigma;       ///< Their standard deviations; infinite where the record does not tell.
  Eigen::MatrixXd covariance;  ///< Of what is observable; 0 in rows and columns of all else.
  std::vector<char> is_observable;
  /// Of known noise: the sum of squares of what is left, in standard deviations, by the degrees of freedom;
  /// about 1 where the rod moves as it says. Of unknown noise 1.
  double misfit = 0;
  int equations = 0;  ///< Scalar ones.
  /// Of friction: what was found last time was less than a hundredth of its standard deviation from that, or
  /// a millionth. Else always.
  bool converged = true;
};

/// The parameters that fit a record best, by linear least squares of the equations of motion. Each equation
/// is one of a mode, times a smooth bump in time, integrated by parts over a window, so that no acceleration
/// is needed (the weak form: M. Shinbrot 1957). With known noise equations are weighted by their covariance,
/// which that of the record makes to first order, and the bias is taken out that the noise of q and v in the
/// coefficients makes. For friction the equations are made linear at what was found so far, until that stays
/// (C. F. Gauss, I. Newton). std::invalid_argument: the problems of the rod, parameters that overlap or none,
/// samples that do not fit.
[[nodiscard]] Identification identify(const Rod& rod, const std::vector<RodParameter>& parameters,
                                      const RodMotionRecord& record, const IdentificationConfig& config = {});

}  // namespace flexura
