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

/// The pan axis of a head: rad, positive to the camera's left.
struct PanConfig : AxisConfig {
  PanConfig();

  double zero = 0;  ///< Position of the axis when the head reads 0, rad.
};

/// The tilt axis of a head: rad, positive upwards.
struct TiltConfig : AxisConfig {
  TiltConfig();

  double zero = 0;  ///< Position of the axis when the head reads 0, rad.
};

/// The zoom of a head, in positions of the lens's table: ratios, or motor counts.
struct ZoomConfig {
  /// Default: 1 to 10 for a linear zoom, otherwise the table's ends.
  std::optional<std::array<double, 2>> limits;
  std::optional<double> max_rate;  ///< Per second; default: the whole range in 3 s.
  /// As in AxisConfig, in positions.
  double max_acceleration = std::numeric_limits<double>::infinity();
  double resolution = 0;
  double backlash = 0;

  /// Returns the axis of this lens's zoom, in positions of its table.
  [[nodiscard]] AxisConfig axis(const ZoomTable& lens) const;
};

/// A pan/tilt/zoom head as described in a file: motion limits and geometry of its axes.
struct HeadConfig {
  PanConfig pan;
  TiltConfig tilt;
  ZoomConfig zoom;
  double delay = 0;                             ///< Delay from a command to the start of its motion, s.
  std::array<double, 3> tilt_axis = {0, 0, 0};  ///< A point of the tilt axis in the panned frame, m.
  std::array<double, 3> pupil = {0, 0, 0};      ///< Entrance pupil at ratio 1, from there, in C's axes, m.
  double pupil_shift = 0;                       ///< Forward shift of the pupil per unit of ratio, m.
};

/// Position of a head, as it reads.
struct HeadState {
  double pan = 0, tilt = 0;  ///< Angles from the axes' zeros, rad.
  double zoom = 1;           ///< Position of the zoom in the lens's table.

  bool operator==(const HeadState&) const = default;
};

const Table<PanConfig>& fields_of(const PanConfig*);
const Table<TiltConfig>& fields_of(const TiltConfig*);
const Table<ZoomConfig>& fields_of(const ZoomConfig*);
const Table<HeadConfig>& fields_of(const HeadConfig*);

/// Geometry of a head's axes.
struct HeadGeometry {
  Eigen::Vector3d tilt_axis = Eigen::Vector3d::Zero();  ///< Point of the tilt axis in the panned frame, m.
  /// Pupil at the present zoom, in C's axes from the tilt axis, m.
  Eigen::Vector3d pupil = Eigen::Vector3d::Zero();
};

/// Returns R_pan, about M's -y by `pan` rad: turns M's z (forward) towards its -x (left).
[[nodiscard]] Eigen::Matrix3d pan_rotation(double pan);
/// Returns R_tilt, about x by `tilt` rad: turns z (forward) towards -y (up).
[[nodiscard]] Eigen::Matrix3d tilt_rotation(double tilt);

/// Returns X_MC: pan about M's vertical axis, translation to the tilt axis, tilt, translation to the pupil.
/// R_MC = R_pan R_tilt, p_MC = R_pan (tilt_axis + R_tilt pupil). The angles are those between the parts:
/// readings plus zeros.
[[nodiscard]] Pose head_pose(const HeadGeometry& geometry, double pan, double tilt);

}  // namespace flexura
