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

/// A rig as tables of a file describe it: what the tasks believe, or what is true.
struct RigConfig {
  ArmConfig arm;
  std::optional<DriveConfig> drive;   ///< None: bends follow commands as their own rates allow.
  std::vector<CameraConfig> cameras;  ///< In the order in which tasks count them.
  std::vector<ObstacleConfig> obstacles = {};
};

/// The document with its table [truth] laid upon the rest: the simulated world as the file describes it, to
/// be read by the same tables. Tables are merged key by key, whatever the unit in which a value is written;
/// arrays of tables entry by entry, those with a `name` by that name and others by their place (an array of
/// another length replaces the one below); anything else is replaced. Without [truth], the document itself.
/// InputError: [truth] is no table, or names an entry that there is not.
[[nodiscard]] Node truth_of(Node document);

/// What keeps `truth` from being a world in which `model` can be believed, "" when nothing does: another kind
/// of arm, another number of sections, drives or axes, other cameras, or images of another size or kind.
[[nodiscard]] std::string truth_problem(const RigConfig& model, const RigConfig& truth);

}  // namespace flexura
