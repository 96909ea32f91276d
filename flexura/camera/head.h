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

  double zero = 0;  ///< Where the axis stands when the head says 0, rad.
};

/// The tilt axis of a head: rad, positive upwards.
struct TiltConfig : AxisConfig {
  TiltConfig();

  double zero = 0;  ///< Where the axis stands when the head says 0, rad.
};

/// The zoom of a head, in positions of the lens's table: ratios, or motor counts.
struct ZoomConfig {
  std::optional<std::array<double, 2>> limits;  ///< 1 to 10 for a linear zoom, else the table's.
  std::optional<double> max_rate;               ///< A second; over all its range in 3 s when left out.
  /// As AxisConfig's, in positions.
  double max_acceleration = std::numeric_limits<double>::infinity();
  double resolution = 0;
  double backlash = 0;

  /// What moves the zoom of this lens, in positions of its table.
  [[nodiscard]] AxisConfig axis(const ZoomTable& lens) const;
};

/// A pan/tilt/zoom head as the file describes it: how its axes move, and where they lie.
struct HeadConfig {
  PanConfig pan;
  TiltConfig tilt;
  ZoomConfig zoom;
  double delay = 0;                             ///< s from a command to the start of its motion.
  std::array<double, 3> tilt_axis = {0, 0, 0};  ///< A point of the tilt axis in the panned frame, m.
  std::array<double, 3> pupil = {0, 0, 0};  ///< The entrance pupil at ratio 1, from there, in C's axes, m.
  double pupil_shift = 0;                   ///< How far a ratio greater by 1 moves the pupil forward, m.
};

/// Where a head stands, as it says itself.
struct HeadState {
  double pan = 0, tilt = 0;  ///< From the axes' zeros, rad.
  double zoom = 1;           ///< A position of the lens's table.

  bool operator==(const HeadState&) const = default;
};

const Table<PanConfig>& fields_of(const PanConfig*);
const Table<TiltConfig>& fields_of(const TiltConfig*);
const Table<ZoomConfig>& fields_of(const ZoomConfig*);
const Table<HeadConfig>& fields_of(const HeadConfig*);

/// Where a head's axes lie.
struct HeadGeometry {
  Eigen::Vector3d tilt_axis = Eigen::Vector3d::Zero();  ///< In the panned frame, m.
  Eigen::Vector3d pupil = Eigen::Vector3d::Zero();      ///< At the zoom as it stands, m.
};

/// R_pan, about M's -y by `pan` rad: turns M's z (forward) towards its -x (left).
[[nodiscard]] Eigen::Matrix3d pan_rotation(double pan);
/// R_tilt, about x by `tilt` rad: turns z (forward) towards -y (up).
[[nodiscard]] Eigen::Matrix3d tilt_rotation(double tilt);

/// X_MC = pan about M's vertical axis, the way to the tilt axis, tilt, the way to the pupil:
/// R_MC = R_pan R_tilt, p_MC = R_pan (tilt_axis + R_tilt pupil).
/// The angles are those between the parts: what the head says and its zeros.
[[nodiscard]] Pose head_pose(const HeadGeometry& geometry, double pan, double tilt);

}  // namespace flexura
