#pragma once

#include <Eigen/Core>

namespace flexura {

/// Returns [w]x: skew(w) * v is w cross v.
[[nodiscard]] Eigen::Matrix3d skew(const Eigen::Vector3d& w);

/// Returns the rotation by |w| rad about w (Rodrigues), smooth through w = 0.
[[nodiscard]] Eigen::Matrix3d so3_exp(const Eigen::Vector3d& w);

/// Returns the rotation vector of `rotation`, rad, of norm at most pi. Of the two at a half turn, it is the
/// one with a positive first component that is not zero.
[[nodiscard]] Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation);

/// Returns the shortest rotation from +Z to `direction`, of any length except 0; half a turn about X for -Z.
[[nodiscard]] Eigen::Matrix3d rotation_from_z(const Eigen::Vector3d& direction);

/// Returns J with omega = J * dw/dt, where omega is the angular velocity of so3_exp(w) in the fixed frame
/// (left Jacobian: I + (1 - cos t)/t^2 [w]x + (t - sin t)/t^3 [w]x^2, t = |w|).
[[nodiscard]] Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& w);

}  // namespace flexura
