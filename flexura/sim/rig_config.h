#pragma once

#include <optional>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/camera/camera_config.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/drive_config.h"
#include "flexura/model/obstacle.h"

namespace flexura {

/// A rig as described by the tables of a file. This rig is either the model that tasks use, or the truth.
struct RigConfig {
  ArmConfig arm;
  /// Drive of the arm; missing: the sections bend as commanded, within their own rates.
  std::optional<DriveConfig> drive;
  std::vector<CameraConfig> cameras;  ///< Cameras. Tasks number the cameras in this order.
  std::vector<ObstacleConfig> obstacles = {};
};

/// Returns the document with the values of its table [truth] instead of the values of the model. The result
/// describes the simulated world and has the format of the model. Tables are merged key by key, even if the
/// keys have different units. Arrays of tables are merged entry by entry: by `name` if entries have names,
/// otherwise by position. An array without names whose length differs replaces the original. All other values
/// are replaced. Without [truth], returns the document itself. Throws InputError if [truth] is not a table,
/// or names a missing entry.
[[nodiscard]] Node truth_of(Node document);

/// Returns why `truth` and `model` do not match, or "" if they do. Both rigs must have equal kinds of arms
/// and equal numbers of sections, drives and axes. The cameras of both rigs must have equal names, and images
/// of equal size and kind.
[[nodiscard]] std::string truth_problem(const RigConfig& model, const RigConfig& truth);

}  // namespace flexura
