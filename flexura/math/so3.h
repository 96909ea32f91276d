#pragma once

#include <Eigen/Core>

namespace flexura {

/// Returns the skew-symmetric matrix [w]x, with skew(w) * v = w cross v.
[[nodiscard]] Eigen::Matrix3d skew(const Eigen::Vector3d& w);

/// Returns the rotation matrix of a rotation by |w| rad about w (Rodrigues' formula). Smooth through w = 0.
[[nodiscard]] Eigen::Matrix3d so3_exp(const Eigen::Vector3d& w);

/// Returns the rotation vector of `rotation`, rad, with norm at most pi. For a half turn, two vectors are
/// possible. The result is then the vector whose first nonzero component is positive.
[[nodiscard]] Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation);

/// Returns the shortest rotation from +Z to `direction`, of any length except 0; half a turn about X for -Z.
[[nodiscard]] Eigen::Matrix3d rotation_from_z(const Eigen::Vector3d& direction);

/// Returns the left Jacobian J, with omega = J * dw/dt, where omega is the angular velocity of so3_exp(w) in
/// the fixed frame. With t = |w|, J = I + (1 - cos t)/t^2 [w]x + (t - sin t)/t^3 [w]x^2.
[[nodiscard]] Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& w);

}  // namespace flexura
