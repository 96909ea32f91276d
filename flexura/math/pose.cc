#include "flexura/math/pose.h"

namespace flexura {
namespace {

// Returns whether the first nonzero component is negative, which is true for exactly one of q and -q.
bool is_negative(const Eigen::Vector4d& q) {
  for (const double component : q) {
    if (component != 0.0) return component < 0.0;
  }
  return false;
}

}  // namespace

Eigen::Vector4d quaternion_wxyz(const Eigen::Matrix3d& rotation) {
  const Eigen::Quaterniond quaternion(rotation);
  Eigen::Vector4d q(quaternion.w(), quaternion.x(), quaternion.y(), quaternion.z());
  if (is_negative(q)) q = -q;
  // Adding zero changes a negative zero, which files would show, to a positive zero.
  return q.normalized() + Eigen::Vector4d::Zero();
}

}  // namespace flexura
