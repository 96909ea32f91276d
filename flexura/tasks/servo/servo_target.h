#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "flexura/tasks/servo/servo_task_config.h"

namespace flexura {

/// Shape of a target for an arm, and its distance from the requested one.
struct ServoTargetShape {
  ArmState state;  ///< Command that makes it.
  /// Distance from the requested target, share of the arm's length. For a position it is the tip's, for a
  /// curve and for angles root mean square along the arm; 0 if exact.
  double missed = 0;
};
/// Returns the shape of a target without pictures, for `arm`, as a command. The search starts at the command
/// `from`.
[[nodiscard]] ServoTargetShape servo_target_shape(const ServoTargetConfig& target, const ArmModel& arm,
                                                  const ArmState& from);

/// Returns the length of the smooth curve through points along the arm, m.
[[nodiscard]] double curve_length(const std::vector<std::array<double, 3>>& points);

/// Returns the shapes of all targets in their order, each search starting from the previous one; std::nullopt
/// for targets by pictures.
[[nodiscard]] std::vector<std::optional<ServoTargetShape>> servo_target_shapes(const ServoTask& task,
                                                                               const ArmModel& arm,
                                                                               ArmState from);

/// Returns the pictures of a target with pictures, from files in `folder` or below. Throws InputError for an
/// invalid picture, or one of another size than its camera's.
[[nodiscard]] RecordedViews recorded_views(const ServoTargetConfig& target,
                                           const std::array<CameraConfig, 2>& cameras,
                                           const std::filesystem::path& folder);

}  // namespace flexura
