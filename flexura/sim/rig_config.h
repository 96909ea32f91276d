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

/// A rig as described by the tables of a file: the model that tasks use, or the truth.
struct RigConfig {
  ArmConfig arm;
  std::optional<DriveConfig> drive;   ///< Missing: the sections bend at their own rates.
  std::vector<CameraConfig> cameras;  ///< In the order in which tasks number them.
  std::vector<ObstacleConfig> obstacles = {};
};

/// Returns the document with its table [truth] merged over the rest: the simulated world, to be read with the
/// same tables. Tables are merged key by key, whatever unit a value is written in. Arrays of tables are
/// merged entry by entry: by `name` if entries have one, otherwise by position. An unnamed array of another
/// length replaces the one below; everything else is replaced. Without [truth], returns the document itself.
/// Throws InputError if [truth] is not a table, or names a missing entry.
[[nodiscard]] Node truth_of(Node document);

/// Returns why `truth` and `model` do not match, or "" if they do. They must have the same kind of arm,
/// numbers of sections, drives and axes, cameras, and image sizes and kinds.
[[nodiscard]] std::string truth_problem(const RigConfig& model, const RigConfig& truth);

}  // namespace flexura
