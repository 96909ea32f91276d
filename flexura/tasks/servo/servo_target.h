#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "flexura/tasks/servo/servo_task_config.h"

namespace flexura {

/// Shape of an arm for a requested target, and the distance between both.
struct ServoTargetShape {
  ArmState state;  ///< Command for this shape.
  /// Distance from the requested target, share of the arm's length. For a target position, this is the
  /// distance of the tip. For a curve or angles, this is the root mean square distance along the arm. The
  /// distance is 0 for an exact shape.
  double missed = 0;
};
/// Returns the shape of `arm` for a target that is not given by pictures. The search starts at the command
/// `from`.
[[nodiscard]] ServoTargetShape servo_target_shape(const ServoTargetConfig& target, const ArmModel& arm,
                                                  const ArmState& from);

/// Returns the length of the smooth curve through points along the arm, m.
[[nodiscard]] double curve_length(const std::vector<std::array<double, 3>>& points);

/// Returns the shapes for all targets in their order; std::nullopt for targets given by pictures. The search
/// for each shape starts at the shape of the previous target.
[[nodiscard]] std::vector<std::optional<ServoTargetShape>> servo_target_shapes(const ServoTask& task,
                                                                               const ArmModel& arm,
                                                                               ArmState from);

/// Returns the pictures of a target that is given by pictures. The picture files are in `folder` or below.
/// Throws InputError if a picture is invalid or does not have the picture size of its camera.
[[nodiscard]] RecordedViews recorded_views(const ServoTargetConfig& target,
                                           const std::array<CameraConfig, 2>& cameras,
                                           const std::filesystem::path& folder);

}  // namespace flexura
