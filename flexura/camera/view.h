#pragma once

#include <Eigen/Core>
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
};

}  // namespace flexura
