#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "flexura/tasks/servo/servo_task_config.h"

namespace flexura {

/// A shape that a target means for an arm, and how far it stays from what was said.
struct ServoTargetShape {
  ArmState state;  ///< The command that makes it.
  /// Share of the arm's length: of a place that of the tip, of a curve and of angles root mean square along
  /// the arm; 0 when the shape is what was asked for.
  double missed = 0;
};
/// That of a target without pictures, for `arm`, as a command. The search for it begins at `from`, another.
[[nodiscard]] ServoTargetShape servo_target_shape(const ServoTargetConfig& target, const ArmModel& arm,
                                                  const ArmState& from);

/// How long the smooth curve is from which points along the arm are taken to be, m.
[[nodiscard]] double curve_length(const std::vector<std::array<double, 3>>& points);

/// Of all targets in their order, each searched for from the one before; none of those by pictures.
[[nodiscard]] std::vector<std::optional<ServoTargetShape>> servo_target_shapes(const ServoTask& task,
                                                                               const ArmModel& arm,
                                                                               ArmState from);

/// The pictures of a target that has some, from files in `folder` or below. InputError: what is no picture,
/// or of another size than its camera takes.
[[nodiscard]] RecordedViews recorded_views(const ServoTargetConfig& target,
                                           const std::array<CameraConfig, 2>& cameras,
                                           const std::filesystem::path& folder);

}  // namespace flexura
