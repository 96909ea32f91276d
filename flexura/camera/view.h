#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"

namespace flexura {

/// View of one camera at one instant: lens at the current zoom, pose of the camera's frame C, and size of the
/// image.
struct View {
  Lens lens{Intrinsics{}};
  /// Pose of C, position in m. C's origin is the entrance pupil. The axes of C are x right, y down, z
  /// forward.
  Pose X_WC;
  int width = 640;   ///< Width of the image, px.
  int height = 480;  ///< Height of the image, px.

  /// Returns the pixel of a point in W, m. The pixel may be outside the image. Returns std::nullopt if the
  /// lens cannot image the point.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_WP) const {
    return lens.project(X_WC.inverse() * p_WP);
  }
  /// Returns the vector in W, perpendicular to the optical axis, to which a pixel difference, px, corresponds
  /// under parallel projection at a depth of 1 m.
  [[nodiscard]] Eigen::Vector3d parallel_way(const Eigen::Vector2d& pixels) const {
    const Intrinsics& by = lens.intrinsics();
    return X_WC.rotation * Eigen::Vector3d(pixels.x() / by.fx, pixels.y() / by.fy, 0);
  }
};

/// Prior standard deviations of the errors of a camera's description; 0: no error.
struct ViewPrior {
  double rotation_std = 0;  ///< Standard deviation of the orientation error about each axis, rad.
  double focal_std = 0;     ///< Relative standard deviation of the focal lengths.

  /// Returns whether any standard deviation is above 0.
  [[nodiscard]] bool is_any() const { return rotation_std > 0 || focal_std > 0; }
};

/// Returns whether two cameras can observe the planes XOY and ZOY: `front` looks along Z and `side` along X,
/// each within about 45 degrees. `front` and `side` are the cameras' poses X_WC.
[[nodiscard]] inline bool stand_for_planes(const Pose& front, const Pose& side) {
  constexpr double roughly = 0.7;
  return std::abs(front.rotation(2, 2)) > roughly && std::abs(side.rotation(0, 2)) > roughly;
}

}  // namespace flexura
