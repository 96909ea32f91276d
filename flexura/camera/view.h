#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "flexura/camera/intrinsics.h"
#include "flexura/math/pose.h"

namespace flexura {

/// View of one camera at one instant: its lens at the present zoom, the pose of its optical frame and its
/// image's size.
struct View {
  Lens lens{Intrinsics{}};
  Pose X_WC;         ///< Origin: the entrance pupil, m; x right, y down, z forward.
  int width = 640;   ///< Width of the image, px.
  int height = 480;  ///< Height of the image, px.

  /// Returns the pixel of a point in W, m, inside the image or not; empty if the lens does not show it.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_WP) const {
    return lens.project(X_WC.inverse() * p_WP);
  }
  /// Returns the vector in W of a pixel difference `pixels`, px, under parallel projection: at depth 1,
  /// without the component along the view.
  [[nodiscard]] Eigen::Vector3d parallel_way(const Eigen::Vector2d& pixels) const {
    const Intrinsics& by = lens.intrinsics();
    return X_WC.rotation * Eigen::Vector3d(pixels.x() / by.fx, pixels.y() / by.fy, 0);
  }
};

/// Prior standard deviations of the error in a camera's description; 0: exact.
struct ViewPrior {
  double rotation_std = 0;  ///< Of the frame's orientation, about each axis, rad.
  double focal_std = 0;     ///< Of the focal lengths, relative.

  /// Whether any of them is above 0.
  [[nodiscard]] bool is_any() const { return rotation_std > 0 || focal_std > 0; }
};

/// Returns whether two cameras represent the planes XOY and ZOY: `front` looks along Z and `side` along X,
/// each within about 45 degrees.
[[nodiscard]] inline bool stand_for_planes(const Pose& front, const Pose& side) {
  constexpr double roughly = 0.7;
  return std::abs(front.rotation(2, 2)) > roughly && std::abs(side.rotation(0, 2)) > roughly;
}

}  // namespace flexura
