#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "flexura/base/fields.h"
#include "flexura/camera/axis_config.h"
#include "flexura/math/pose.h"

namespace flexura {

/// One linear axis of a stage; positions are in m. The default limits allow no travel.
struct SlideConfig : AxisConfig {
  SlideConfig();
};

/// A linear stage that translates the mount along the mount's axes.
struct StageConfig {
  SlideConfig x, y, z;  ///< Axes to the right, downwards, and forwards.
  double delay = 0;     ///< Delay from a command to the start of the motion, s.

  /// Returns whether any axis can travel.
  [[nodiscard]] bool can_move() const;
};

/// Position of a stage: the mount's offset along the mount's axes (right, down, forward), m.
struct StageState {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();

  bool operator==(const StageState&) const = default;
};

/// Pose of a camera's mount in a file. Either `look_at` or `rotation` gives the orientation.
struct MountConfig {
  std::array<double, 3> position = {0, 0, 0};  ///< Position p_WM at stage offset 0, m.
  std::optional<std::array<double, 3>>
      look_at;      ///< Point in W, m, towards which M's z points. M's y points downwards as far as possible.
  double roll = 0;  ///< Additional rotation about M's z, with look_at only, rad.
  /// Unit quaternion (w, x, y, z) of R_WM, instead of look_at.
  std::optional<std::array<double, 4>> rotation;
  StageConfig stage;

  /// Returns X_WM at stage offset 0. Throws std::invalid_argument unless exactly one of look_at and rotation
  /// is given. Also throws std::invalid_argument if look_at is M's origin, or is vertically above or below
  /// this origin. Also throws std::invalid_argument for a quaternion whose norm differs from 1 by more than
  /// 1e-3, and for a roll together with rotation.
  [[nodiscard]] Pose pose() const;
};

const Table<SlideConfig>& fields_of(const SlideConfig*);
const Table<StageConfig>& fields_of(const StageConfig*);
const Table<MountConfig>& fields_of(const MountConfig*);

/// Returns the orientation of a camera that looks along `forward` and has W's vertical upright in its image.
/// The columns are the camera's axes in W: right, down, forward. `forward`: vector in W with any length.
/// Returns std::nullopt if `forward` is vertical or zero.
[[nodiscard]] std::optional<Eigen::Matrix3d> upright(const Eigen::Vector3d& forward);

/// Returns a camera's rotation about its optical axis relative to the upright orientation, rad in (-pi, pi].
/// Positive is clockwise seen from behind the camera. A pan/tilt head cannot correct this rotation. Returns
/// std::nullopt if the camera looks exactly up or down.
[[nodiscard]] std::optional<double> roll_of(const Eigen::Matrix3d& R_WC);

}  // namespace flexura
