#pragma once

#include <Eigen/Core>

#include "flexura/math/pose.h"

// Twists and wrenches, linear first: [v; w] and [f; m] (docs/conventions.md).
namespace flexura {

using Vector6d = Eigen::Vector<double, 6>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// The Lie bracket [a, b] of two twists.
[[nodiscard]] Vector6d bracket(const Vector6d& a, const Vector6d& b);

/// ad(a) b = [a, b].
[[nodiscard]] Matrix6d ad(const Vector6d& a);

/// B with W . [a, b] = a^T B b for all twists a and b. Symmetric where W has no moment.
[[nodiscard]] Matrix6d bracket_form(const Vector6d& W);

/// Takes twists of B, about B's origin and in its axes, to those of A: V_A = adjoint(X_AB) V_B. Wrenches go
/// the other way by its transpose.
[[nodiscard]] Matrix6d adjoint(const Pose& X_AB);

/// exp of a twist: the pose at the end of a unit of time at constant velocity. Smooth through 0.
[[nodiscard]] Pose se3_exp(const Vector6d& twist);

/// exp of a twist t and its first two derivatives, in closed form (J. M. Selig, Geometric Fundamentals of
/// Robotics, sec. 4.4), without cancellation at 0.
struct TwistExponential {
  /// exp of a twist, with its first derivative.
  explicit TwistExponential(const Vector6d& given);

  /// Of a wrench W, in A: M with W . (d jacobian(t + h a) / dh) b = a^T M b.
  [[nodiscard]] Matrix6d jacobian_form(const Vector6d& W) const;

  Vector6d twist;
  Pose pose;          ///< X_AB
  Matrix6d jacobian;  ///< V_A, the twist of B in A, by dt/dtime (the left Jacobian).

 private:
  double angle_squared_;
  Matrix6d ad_;
};

}  // namespace flexura
