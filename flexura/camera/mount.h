#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "flexura/base/fields.h"
#include "flexura/camera/axis_config.h"
#include "flexura/math/pose.h"

namespace flexura {

/// One axis of a stage, m. Has no travel unless limits are given.
struct SlideConfig : AxisConfig {
  SlideConfig();
};

/// Translates a mount along its own axes.
struct StageConfig {
  SlideConfig x, y, z;  ///< Right, down, forward.
  double delay = 0;     ///< Delay from a command to the start of its motion, s.

  /// Returns whether it travels along any axis.
  [[nodiscard]] bool can_move() const;
};

/// Position of a stage: the mount's offset along its own axes (right, down, forward), m.
struct StageState {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();

  bool operator==(const StageState&) const = default;
};

/// Pose of a camera's mount as given in a file. The orientation is given in one of two ways.
struct MountConfig {
  std::array<double, 3> position = {0, 0, 0};    ///< Position p_WM at stage offset 0, m.
  std::optional<std::array<double, 3>> look_at;  ///< M's z points to this point of W; M's y downwards.
  double roll = 0;                               ///< Rotation about z after look_at, rad.
  /// Instead of look_at, the quaternion (w, x, y, z) of R_WM.
  std::optional<std::array<double, 4>> rotation;
  StageConfig stage;

  /// Returns X_WM at stage offset 0. Throws std::invalid_argument for no orientation or two, or a look_at in
  /// M's origin or exactly above or below it. Also for a quaternion whose norm is not 1 (to 1e-3), or a roll
  /// beside a rotation.
  [[nodiscard]] Pose pose() const;
};

const Table<SlideConfig>& fields_of(const SlideConfig*);
const Table<StageConfig>& fields_of(const StageConfig*);
const Table<MountConfig>& fields_of(const MountConfig*);

/// Returns the axes in W (columns: right, down, forward) of a camera with W's vertical upright in its image.
/// It looks along `forward` (in W, of any length). Empty if it looks exactly up or down, or if `forward` is
/// zero.
[[nodiscard]] std::optional<Eigen::Matrix3d> upright(const Eigen::Vector3d& forward);

/// Returns a camera's rotation about its optical axis from upright, rad in (-pi, pi], clockwise seen from
/// behind the camera: a pan/tilt head cannot correct it. Empty if the camera looks exactly up or down.
[[nodiscard]] std::optional<double> roll_of(const Eigen::Matrix3d& R_WC);

}  // namespace flexura
