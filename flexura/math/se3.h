#pragma once

#include <Eigen/Core>

#include "flexura/math/pose.h"

// Twists and wrenches, linear first: [v; w] and [f; m] (docs/conventions.md).
namespace flexura {

using Vector6d = Eigen::Vector<double, 6>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Returns the Lie bracket [a, b] of two twists.
[[nodiscard]] Vector6d bracket(const Vector6d& a, const Vector6d& b);

/// Returns the matrix with ad(a) b = [a, b].
[[nodiscard]] Matrix6d ad(const Vector6d& a);

/// Returns B with W . [a, b] = a^T B b for all twists a and b. Symmetric if W has no moment.
[[nodiscard]] Matrix6d bracket_form(const Vector6d& W);

/// Returns the matrix that converts twists of B, about B's origin and in its axes, to those of A: V_A =
/// adjoint(X_AB) V_B. Its transpose converts wrenches in the opposite direction.
[[nodiscard]] Matrix6d adjoint(const Pose& X_AB);

/// Returns the exponential of a twist: the pose after a unit of time at constant velocity. Smooth through 0.
[[nodiscard]] Pose se3_exp(const Vector6d& twist);

/// Exponential of a twist t and its first two derivatives, in closed form (J. M. Selig, Geometric
/// Fundamentals of Robotics, sec. 4.4), without cancellation at 0.
struct TwistExponential {
  /// Computes the exponential of a twist, with its first derivative.
  explicit TwistExponential(const Vector6d& given);

  /// Returns M for a wrench W in A: W . (d jacobian(t + h a) / dh) b = a^T M b.
  [[nodiscard]] Matrix6d jacobian_form(const Vector6d& W) const;

  Vector6d twist;
  Pose pose;          ///< X_AB.
  Matrix6d jacobian;  ///< V_A, the twist of B in A, by dt/dtime (the left Jacobian).

 private:
  double angle_squared_;
  Matrix6d ad_;
};

}  // namespace flexura
