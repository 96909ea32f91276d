#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"

namespace flexura {

/// What one camera sees at one instant: its lens as it stands, the pose of its optical frame and its image's
/// size.
struct View {
  Lens lens{Intrinsics{}};
  Pose X_WC;         ///< Origin: the entrance pupil, m; x right, y down, z forward.
  int width = 640;   ///< px
  int height = 480;  ///< px

  /// The pixel of a point in W, m, inside the image or not; none where the lens shows it nowhere.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_WP) const {
    return lens.project(X_WC.inverse() * p_WP);
  }
  /// The way `pixels` px from one pixel to another as a parallel projection shows it: in W, at depth 1,
  /// without the part along the view.
  [[nodiscard]] Eigen::Vector3d parallel_way(const Eigen::Vector2d& pixels) const {
    const Intrinsics& by = lens.intrinsics();
    return X_WC.rotation * Eigen::Vector3d(pixels.x() / by.fx, pixels.y() / by.fy, 0);
  }
};

/// Prior standard deviations of the error in a camera's description; 0: exact.
struct ViewDoubt {
  double rotation_std = 0;  ///< Of the frame's orientation, about each axis, rad.
  double focal_std = 0;     ///< Of the focal lengths, relative.

  /// Whether any of them is above 0.
  [[nodiscard]] bool is_any() const { return rotation_std > 0 || focal_std > 0; }
};

/// Whether two cameras stand for the planes XOY and ZOY: `front` looks along Z and `side` along X, each
/// within 45 degrees or so.
[[nodiscard]] inline bool stand_for_planes(const Pose& front, const Pose& side) {
  constexpr double roughly = 0.7;
  return std::abs(front.rotation(2, 2)) > roughly && std::abs(side.rotation(0, 2)) > roughly;
}

}  // namespace flexura
