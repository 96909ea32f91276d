#pragma once

#include <Eigen/Core>

#include "flexura/math/pose.h"

// Twists [v; w] and wrenches [f; m], the linear part first (docs/conventions.md).
namespace flexura {

using Vector6d = Eigen::Vector<double, 6>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Returns the Lie bracket [a, b] of two twists.
[[nodiscard]] Vector6d bracket(const Vector6d& a, const Vector6d& b);

/// Returns the matrix ad(a), with ad(a) b = [a, b] for every twist b.
[[nodiscard]] Matrix6d ad(const Vector6d& a);

/// Returns, for a wrench W, the matrix B with W . [a, b] = a^T B b for all twists a and b. B is symmetric if
/// W has no moment.
[[nodiscard]] Matrix6d bracket_form(const Vector6d& W);

/// Returns the matrix that converts a twist from frame B to frame A: V_A = adjoint(X_AB) V_B. In each frame a
/// twist refers to the frame's origin and axes. The transposed matrix converts a wrench from A to B.
[[nodiscard]] Matrix6d adjoint(const Pose& X_AB);

/// Returns the exponential of a twist: the pose reached from the identity after unit time at this constant
/// body twist. Smooth through 0.
[[nodiscard]] Pose se3_exp(const Vector6d& twist);

/// Exponential X_AB of a twist t, with its first two derivatives, in closed form (Selig, Geometric
/// Fundamentals of Robotics, sec. 4.4). Accurate also for small t.
struct TwistExponential {
  /// Computes the exponential of a twist, with its first derivative.
  explicit TwistExponential(const Vector6d& given);

  /// Returns, for a wrench W in A, the matrix M with W^T (d jacobian(t + h a) / dh) b = a^T M b for all
  /// twists a and b.
  [[nodiscard]] Matrix6d jacobian_form(const Vector6d& W) const;

  Vector6d twist;
  Pose pose;          ///< X_AB.
  Matrix6d jacobian;  ///< Left Jacobian J: the twist of B in A is V_A = J dt/dtime.

 private:
  double angle_squared_;
  Matrix6d ad_;
};

}  // namespace flexura
