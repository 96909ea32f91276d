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

/// Pixel of a point in W and its derivatives: px per m, rad, or unit of zoom.
struct CameraProjection {
  Eigen::Vector2d pixel;                 ///< Pixel (u, v), px; inside the image or not.
  Eigen::Matrix<double, 2, 3> by_point;  ///< Derivative by the point in W.
  /// Derivative by a small motion [v; w] of the mount, V_WM_W: p_WM + v, exp(w) R_WM, in W's axes.
  Eigen::Matrix<double, 2, 6> by_mount;
  Eigen::Matrix<double, 2, 3> by_stage;  ///< Derivative by the stage's offset.
  Eigen::Vector2d by_pan, by_tilt;       ///< Derivatives by pan and tilt, px/rad.
  Eigen::Vector2d by_zoom;               ///< Derivative by the zoom, through the lens and the pupil's shift.
  Eigen::Matrix<double, 2, 3> by_tilt_axis;  ///< Derivative by HeadConfig::tilt_axis.
  Eigen::Matrix<double, 2, 3> by_pupil;      ///< Derivative by HeadConfig::pupil.
  Eigen::Vector2d by_pupil_shift;            ///< Derivative by HeadConfig::pupil_shift.
  /// Derivative by the intrinsics at this zoom: fx, fy, cx, cy, k1, ...
  Eigen::Matrix<double, 2, intrinsics_count> by_intrinsics;
  /// Derivative by the intrinsics at ratio 1, on which those at this zoom depend. (By a zoom table's row:
  /// by_intrinsics * ZoomTable::by_row().asDiagonal().)
  Eigen::Matrix<double, 2, intrinsics_count> by_lens;
};

/// Positions of a camera's head and stage axes.
struct CameraStance {
  HeadState head;
  StageState stage;

  bool operator==(const CameraStance&) const = default;
};

/// Returns the stance at `fraction` of the way from one to another, with pan, tilt, zoom and offset linear.
[[nodiscard]] CameraStance interpolate(const CameraStance& from, const CameraStance& to, double fraction);

/// A camera on its head and mount.
class Camera {
 public:
  /// Throws std::invalid_argument for an invalid lens or mount (ZoomTable, MountConfig::pose).
  explicit Camera(const CameraConfig& config);

  [[nodiscard]] const CameraConfig& config() const { return config_; }
  /// The lens at every zoom, for this sensor's size.
  [[nodiscard]] const ZoomTable& lens() const { return lens_; }
  /// X_WM at stage offset 0.
  [[nodiscard]] const Pose& mount() const { return X_WM_; }

  /// Motion limits of pan, tilt (rad) and zoom (its own unit), with the zoom's defaults from the lens.
  [[nodiscard]] const std::array<AxisConfig, 3>& head_axes() const { return head_axes_; }
  /// Motion limits of the stage's x, y and z, m.
  [[nodiscard]] const std::array<AxisConfig, 3>& stage_axes() const { return stage_axes_; }

  /// Positions at the start of a run.
  [[nodiscard]] HeadState initial_head() const;
  [[nodiscard]] StageState initial_stage() const;
  [[nodiscard]] CameraStance initial_stance() const { return {initial_head(), initial_stage()}; }

  /// Returns the angles of its pan and tilt axes, zeros included, rad.
  [[nodiscard]] std::array<double, 2> angles(const HeadState& head) const;
  /// Returns the head position that looks along a direction of W (of any length but 0), with this zoom.
  /// Neither clamped nor quantised; of the pans that differ by full turns, the one nearest to the middle of
  /// its limits.
  [[nodiscard]] HeadState looking_along(const Eigen::Vector3d& direction, double zoom) const;

  /// Returns X_WC: the entrance pupil's position and the camera's axes. This and the following functions
  /// throw std::out_of_range for a zoom outside the lens's table.
  [[nodiscard]] Pose pose(const CameraStance& stance) const;
  /// Returns the view in this stance.
  [[nodiscard]] View view(const CameraStance& stance) const;
  /// Returns the pixel of a point in W with its derivatives; empty if the lens does not show it.
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
