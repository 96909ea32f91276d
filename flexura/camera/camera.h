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

/// A pixel of a point in W, and how it changes with all that it depends on: px per m, rad, or unit of zoom.
struct CameraProjection {
  Eigen::Vector2d pixel;                 ///< (u, v), px; in the image or not.
  Eigen::Matrix<double, 2, 3> by_point;  ///< The point in W.
  /// A small motion [v; w] of the mount, V_WM_W: p_WM + v, exp(w) R_WM, in W's axes.
  Eigen::Matrix<double, 2, 6> by_mount;
  Eigen::Matrix<double, 2, 3> by_stage;                      ///< The stage's offset.
  Eigen::Vector2d by_pan, by_tilt;                           ///< px/rad
  Eigen::Vector2d by_zoom;                                   ///< Through the lens and the pupil's shift.
  Eigen::Matrix<double, 2, 3> by_tilt_axis;                  ///< HeadConfig::tilt_axis.
  Eigen::Matrix<double, 2, 3> by_pupil;                      ///< HeadConfig::pupil.
  Eigen::Vector2d by_pupil_shift;                            ///< HeadConfig::pupil_shift.
  Eigen::Matrix<double, 2, intrinsics_count> by_intrinsics;  ///< At this zoom; fx, fy, cx, cy, k1, ...
  /// The same of the lens at ratio 1, on which those at this zoom depend. (By a zoom table's row:
  /// by_intrinsics * ZoomTable::by_row().asDiagonal().)
  Eigen::Matrix<double, 2, intrinsics_count> by_lens;
};

/// Where a camera's head and stage stand.
struct CameraStance {
  HeadState head;
  StageState stage;

  bool operator==(const CameraStance&) const = default;
};

/// The stance `fraction` of the way from one to another, pan, tilt, zoom and offset each linear.
[[nodiscard]] CameraStance interpolate(const CameraStance& from, const CameraStance& to, double fraction);

/// A camera on its head and mount, ready to use.
class Camera {
 public:
  /// std::invalid_argument: a lens or a mount that is none (ZoomTable, MountConfig::pose).
  explicit Camera(const CameraConfig& config);

  [[nodiscard]] const CameraConfig& config() const { return config_; }
  /// The lens at every zoom, for this sensor's size.
  [[nodiscard]] const ZoomTable& lens() const { return lens_; }
  /// X_WM at stage offset 0.
  [[nodiscard]] const Pose& mount() const { return X_WM_; }

  /// How pan, tilt (rad) and zoom (its own unit) move, the zoom's defaults filled in from the lens.
  [[nodiscard]] const std::array<AxisConfig, 3>& head_axes() const { return head_axes_; }
  /// How the stage's x, y and z move, m.
  [[nodiscard]] const std::array<AxisConfig, 3>& stage_axes() const { return stage_axes_; }

  /// Where it stands when a run starts.
  [[nodiscard]] HeadState initial_head() const;
  [[nodiscard]] StageState initial_stage() const;
  [[nodiscard]] CameraStance initial_stance() const { return {initial_head(), initial_stage()}; }

  /// The angles of its pan and its tilt axis, zeros included, rad.
  [[nodiscard]] std::array<double, 2> angles(const HeadState& head) const;
  /// The head that looks along a direction of W (of any length but 0), with this zoom. Not drawn to limits or
  /// steps; of the pans that differ by whole turns the one nearest to the middle of its limits.
  [[nodiscard]] HeadState looking_along(const Eigen::Vector3d& direction, double zoom) const;

  /// X_WC: the entrance pupil's position, and the camera's axes. std::out_of_range: a zoom outside the lens's
  /// table (these and the following).
  [[nodiscard]] Pose pose(const CameraStance& stance) const;
  /// What it sees.
  [[nodiscard]] View view(const CameraStance& stance) const;
  /// The pixel of a point in W with its derivatives; none where the lens shows it nowhere.
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
