#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace flexura {

/// Rigid transform X_AB: the pose of frame B in frame A (docs/conventions.md, "Frames").
struct Pose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< R_AB: columns are B's axes in A.
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      ///< p_AB: B's origin in A, m.

  /// Returns X_AC = X_AB * X_BC.
  [[nodiscard]] Pose operator*(const Pose& X_BC) const {
    return {rotation * X_BC.rotation, position + rotation * X_BC.position};
  }
  /// Returns p_AP = X_AB * p_BP.
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& p_BP) const {
    return position + rotation * p_BP;
  }
  /// Returns X_BA.
  [[nodiscard]] Pose inverse() const { return {rotation.transpose(), -(rotation.transpose() * position)}; }
};

/// Returns the unit quaternion (w, x, y, z) of a rotation matrix. Among q and -q, returns the quaternion
/// whose first nonzero component is positive. No component is a negative zero.
[[nodiscard]] Eigen::Vector4d quaternion_wxyz(const Eigen::Matrix3d& rotation);

}  // namespace flexura
