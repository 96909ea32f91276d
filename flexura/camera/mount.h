#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "flexura/base/fields.h"
#include "flexura/camera/axis_config.h"
#include "flexura/math/pose.h"

namespace flexura {

/// One axis of a stage, m. Without travel unless it is given limits.
struct SlideConfig : AxisConfig {
  SlideConfig();
};

/// What translates a mount along its own axes.
struct StageConfig {
  SlideConfig x, y, z;  ///< Right, down, forward.
  double delay = 0;     ///< s from a command to the start of its motion.

  /// Whether it travels along any axis.
  [[nodiscard]] bool can_move() const;
};

/// Where a stage stands: the mount's offset along its own axes (right, down, forward), m.
struct StageState {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();

  bool operator==(const StageState&) const = default;
};

/// Where a camera's head is mounted, as the file says it. The orientation is given in one of two ways.
struct MountConfig {
  std::array<double, 3> position = {0, 0, 0};     ///< p_WM at stage offset 0, m.
  std::optional<std::array<double, 3>> look_at;   ///< M's z points to this point of W; M's y downwards.
  double roll = 0;                                ///< With look_at: about z after that, rad.
  std::optional<std::array<double, 4>> rotation;  ///< Or the quaternion (w, x, y, z) of R_WM.
  StageConfig stage;

  /// X_WM at stage offset 0. std::invalid_argument: no orientation or two, a look_at in M's origin or
  /// straight above or below it, a quaternion whose norm is not 1 (to 1e-3), a roll beside a rotation.
  [[nodiscard]] Pose pose() const;
};

const Table<SlideConfig>& fields_of(const SlideConfig*);
const Table<StageConfig>& fields_of(const StageConfig*);
const Table<MountConfig>& fields_of(const MountConfig*);

/// The axes in W (columns: right, down, forward) of a camera that looks along `forward` (in W, of any length)
/// and has W's vertical upright in its image; none when it looks straight up or down, or nowhere.
[[nodiscard]] std::optional<Eigen::Matrix3d> upright(const Eigen::Vector3d& forward);

/// A camera's turn about its optical axis from upright, rad in (-pi, pi], clockwise seen from behind the
/// camera: what a pan/tilt head cannot correct. None for one that looks straight up or down.
[[nodiscard]] std::optional<double> roll_of(const Eigen::Matrix3d& R_WC);

}  // namespace flexura
