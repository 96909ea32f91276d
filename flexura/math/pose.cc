#include "flexura/math/pose.h"

namespace flexura {
namespace {

// Returns true if the first component that is not zero is negative: true for exactly one of q and -q.
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
  // Adding zero turns a negative zero, which a file would show, into a positive one.
  return q.normalized() + Eigen::Vector4d::Zero();
}

}  // namespace flexura
