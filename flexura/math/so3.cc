#include "flexura/math/so3.h"

#include <cmath>

#include "flexura/math/pose.h"
#include "flexura/math/series.h"

namespace flexura {

Eigen::Matrix3d skew(const Eigen::Vector3d& w) {
  Eigen::Matrix3d result;
  result << 0.0, -w.z(), w.y(), w.z(), 0.0, -w.x(), -w.y(), w.x(), 0.0;
  return result;
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& w) {
  const double t = w.norm();
  const Eigen::Matrix3d W = skew(w);
  return Eigen::Matrix3d::Identity() + sinc(t) * W + cosc(t) * (W * W);
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation) {
  const Eigen::Vector4d q = quaternion_wxyz(rotation);
  const Eigen::Vector3d axis = q.tail<3>();
  const double sine = axis.stableNorm();  // Sine of half the angle; the plain norm underflows.
  if (sine == 0.0) return Eigen::Vector3d::Zero();
  return axis * (2.0 * std::atan2(sine, q[0]) / sine);
}

Eigen::Matrix3d rotation_from_z(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d = direction.stableNormalized();
  const Eigen::Vector3d axis(-d.y(), d.x(), 0.0);  // Z x d; its norm is the sine of the angle.
  const double sine = axis.stableNorm();
  if (sine == 0.0)
    return Eigen::Vector3d(1.0, std::copysign(1.0, d.z()), std::copysign(1.0, d.z())).asDiagonal();
  return so3_exp(axis * (std::atan2(sine, d.z()) / sine));
}

Eigen::Matrix3d so3_left_jacobian(const Eigen::Vector3d& w) {
  const double t = w.norm();
  const Eigen::Matrix3d W = skew(w);
  return Eigen::Matrix3d::Identity() + cosc(t) * W + sinc_deficit(t) * (W * W);
}

}  // namespace flexura
