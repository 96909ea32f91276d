#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "flexura/camera/camera_config.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/camera/view.h"
#include "flexura/camera/zoom.h"
#include "flexura/math/pose.h"

namespace flexura {

/// Pixel of a point in W, and the pixel's derivatives, in px per m, rad or unit of zoom position.
struct CameraProjection {
  Eigen::Vector2d pixel;                 ///< Pixel (u, v), px; may be outside the image.
  Eigen::Matrix<double, 2, 3> by_point;  ///< Derivative with respect to the point in W, px/m.
  /// Derivative with respect to a small motion [v; w] of the mount in W's axes (V_WM_W). The motion changes
  /// the position to p_WM + v and the rotation to exp(w) R_WM.
  Eigen::Matrix<double, 2, 6> by_mount;
  Eigen::Matrix<double, 2, 3> by_stage;  ///< Derivative with respect to the stage's offset, px/m.
  Eigen::Vector2d by_pan, by_tilt;       ///< Derivatives with respect to pan and tilt, px/rad.
  /// Derivative with respect to the zoom position, including the shift of the pupil.
  Eigen::Vector2d by_zoom;
  Eigen::Matrix<double, 2, 3> by_tilt_axis;  ///< Derivative with respect to HeadConfig::tilt_axis, px/m.
  Eigen::Matrix<double, 2, 3> by_pupil;      ///< Derivative with respect to HeadConfig::pupil, px/m.
  Eigen::Vector2d by_pupil_shift;            ///< Derivative with respect to HeadConfig::pupil_shift, px/m.
  /// Derivative with respect to the intrinsics at this zoom, in the order fx, fy, cx, cy, k1, ...
  Eigen::Matrix<double, 2, intrinsics_count> by_intrinsics;
  /// Derivative with respect to the intrinsics at ratio 1, which affect those at this zoom. The derivative
  /// with respect to a row of the zoom table is by_intrinsics * ZoomTable::by_row().asDiagonal().
  Eigen::Matrix<double, 2, intrinsics_count> by_lens;
};

/// Positions of a camera's head and stage axes.
struct CameraStance {
  HeadState head;
  StageState stage;

  bool operator==(const CameraStance&) const = default;
};

/// Interpolates pan, tilt, zoom and stage offset linearly between two stances: `from` at fraction 0, `to` at
/// fraction 1.
[[nodiscard]] CameraStance interpolate(const CameraStance& from, const CameraStance& to, double fraction);

/// A camera on its head and mount.
class Camera {
 public:
  /// Throws std::invalid_argument for an invalid lens (see ZoomTable) or mount (see MountConfig::pose).
  explicit Camera(const CameraConfig& config);

  [[nodiscard]] const CameraConfig& config() const { return config_; }
  /// The lens's intrinsics as a function of the zoom position, for the sensor's size.
  [[nodiscard]] const ZoomTable& lens() const { return lens_; }
  /// Pose X_WM of the mount at stage offset 0.
  [[nodiscard]] const Pose& mount() const { return X_WM_; }

  /// Motion limits of pan and tilt, rad, and of the zoom position. If the file omits the zoom limits, they
  /// are those of the lens.
  [[nodiscard]] const std::array<AxisConfig, 3>& head_axes() const { return head_axes_; }
  /// Motion limits of the stage's x, y and z, m.
  [[nodiscard]] const std::array<AxisConfig, 3>& stage_axes() const { return stage_axes_; }

  /// Positions of the axes at the start of a run.
  [[nodiscard]] HeadState initial_head() const;
  [[nodiscard]] StageState initial_stage() const;
  [[nodiscard]] CameraStance initial_stance() const { return {initial_head(), initial_stage()}; }

  /// Returns the true angles of the pan and tilt axes, rad: measured angles plus zero offsets.
  [[nodiscard]] std::array<double, 2> angles(const HeadState& head) const;
  /// Returns the head position with the given zoom at which the camera looks along `direction`, a vector in W
  /// with any length above 0. The result is neither clamped to limits nor quantised. Of the pan angles that
  /// differ by full turns, the result has the pan angle nearest to the middle of the pan limits.
  [[nodiscard]] HeadState looking_along(const Eigen::Vector3d& direction, double zoom) const;

  /// Returns the pose X_WC of the camera's frame, whose origin is the entrance pupil. This function and the
  /// following ones throw std::out_of_range for a zoom outside the lens's table.
  [[nodiscard]] Pose pose(const CameraStance& stance) const;
  /// Returns the camera's view in a stance.
  [[nodiscard]] View view(const CameraStance& stance) const;
  /// Returns the pixel of a point in W, m, with its derivatives; std::nullopt if the lens cannot image the
  /// point.
  [[nodiscard]] std::optional<CameraProjection> project(const Eigen::Vector3d& p_WP,
                                                        const CameraStance& stance) const;

 private:
  [[nodiscard]] HeadGeometry geometry(double zoom) const;

  CameraConfig config_;
  ZoomTable lens_;
  Pose X_WM_;
  std::array<AxisConfig, 3> head_axes_, stage_axes_;
};

}  // namespace flexura
