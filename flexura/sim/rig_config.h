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
  /// Missing: the sections bend as commanded, within their own bend rates.
  std::optional<DriveConfig> drive;
  std::vector<CameraConfig> cameras;  ///< In the order in which tasks number them.
  std::vector<ObstacleConfig> obstacles = {};
};

/// Returns the document with its table [truth] merged over the rest. The result describes the simulated world
/// and is read with the same tables. Tables are merged key by key, also if units in keys differ. Arrays of
/// tables are merged entry by entry: by `name` if entries have one, otherwise by position. An array without
/// names and with another length replaces the original. All other values are replaced. Without [truth],
/// returns the document itself. Throws InputError if [truth] is not a table, or names a missing entry.
[[nodiscard]] Node truth_of(Node document);

/// Returns why `truth` and `model` do not match, or "" if they do. They must have the same kind of arm and
/// the same numbers of sections, drives and axes. Their cameras must have the same names, and the same sizes
/// and kinds of images.
[[nodiscard]] std::string truth_problem(const RigConfig& model, const RigConfig& truth);

}  // namespace flexura
