#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <optional>

#include "flexura/base/fields.h"
#include "flexura/camera/axis_config.h"
#include "flexura/camera/zoom.h"
#include "flexura/math/pose.h"

namespace flexura {

/// The pan axis of a head. Angles are in rad, positive to the camera's left.
struct PanConfig : AxisConfig {
  PanConfig();

  double zero = 0;  ///< True angle of the axis when the head reports 0, rad.
};

/// The tilt axis of a head. Angles are in rad, positive upwards.
struct TiltConfig : AxisConfig {
  TiltConfig();

  double zero = 0;  ///< True angle of the axis when the head reports 0, rad.
};

/// The zoom axis of a head. Zoom positions are ratios, or motor positions if the lens's table has counts.
struct ZoomConfig {
  /// Smallest and largest zoom position. Default: 1 to 10 for a linear zoom, otherwise the range of the
  /// lens's table.
  std::optional<std::array<double, 2>> limits;
  std::optional<double>
      max_rate;  ///< Largest speed, units of zoom position per second; default: the whole range in 3 s.
  /// This member and the following ones are as in AxisConfig, in units of zoom position.
  double max_acceleration = std::numeric_limits<double>::infinity();
  double resolution = 0;
  double backlash = 0;

  /// Returns the motion limits of the zoom axis with this lens, in units of zoom position.
  [[nodiscard]] AxisConfig axis(const ZoomTable& lens) const;
};

/// A pan/tilt/zoom head as described in a file: motion limits and geometry of the axes.
struct HeadConfig {
  PanConfig pan;
  TiltConfig tilt;
  ZoomConfig zoom;
  double delay = 0;  ///< Delay from a command to the start of the motion, s.
  std::array<double, 3> tilt_axis = {
      0, 0, 0};  ///< A point on the tilt axis, in the mount's frame rotated by pan, m.
  std::array<double, 3> pupil = {
      0, 0, 0};            ///< Entrance pupil at zoom ratio 1, relative to `tilt_axis`, in C's axes, m.
  double pupil_shift = 0;  ///< Forward shift of the entrance pupil per unit of zoom ratio, m.
};

/// Position of a head, as it is commanded and reported.
struct HeadState {
  double pan = 0, tilt = 0;  ///< Angles relative to the axes' zero offsets, rad.
  double zoom = 1;           ///< Zoom position: ratio, or motor position if the lens's table has counts.

  bool operator==(const HeadState&) const = default;
};

const Table<PanConfig>& fields_of(const PanConfig*);
const Table<TiltConfig>& fields_of(const TiltConfig*);
const Table<ZoomConfig>& fields_of(const ZoomConfig*);
const Table<HeadConfig>& fields_of(const HeadConfig*);

/// Geometry of a head's axes at one zoom position.
struct HeadGeometry {
  /// A point on the tilt axis, in the mount's frame rotated by pan, m.
  Eigen::Vector3d tilt_axis = Eigen::Vector3d::Zero();
  /// Entrance pupil relative to `tilt_axis`, in C's axes, m.
  Eigen::Vector3d pupil = Eigen::Vector3d::Zero();
};

/// Returns R_pan, the rotation about M's -y by `pan` rad. A positive angle rotates M's z (forward) towards
/// M's -x (left).
[[nodiscard]] Eigen::Matrix3d pan_rotation(double pan);
/// Returns R_tilt, the rotation about x by `tilt` rad. A positive angle rotates z (forward) towards -y (up).
[[nodiscard]] Eigen::Matrix3d tilt_rotation(double tilt);

/// Returns the camera's pose in the mount's frame, X_MC: pan about M's vertical axis, translation to the tilt
/// axis, tilt, and translation to the pupil. R_MC = R_pan R_tilt and p_MC = R_pan (tilt_axis + R_tilt pupil).
/// `pan` and `tilt` are the true angles of the axes, rad.
[[nodiscard]] Pose head_pose(const HeadGeometry& geometry, double pan, double tilt);

}  // namespace flexura
