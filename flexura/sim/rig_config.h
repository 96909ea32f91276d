#pragma once

#include <optional>
#include <string>
#include <vector>

#include "flexura/base/node.h"
#include "flexura/camera/camera_config.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_contact.h"
#include "flexura/mechanics/rod_drag.h"
#include "flexura/mechanics/surroundings.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/drive.h"
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

/// The rod that an arm is, and what pulls at it beside its tendons.
struct ArmRod {
  Rod rod;
  RodLoads loads;
  std::vector<TendonBreak> breaks = {};
  std::optional<double> time_step = {};  ///< Of its motion, s. None: it has no inertia, and none of the next.
  std::optional<RodContactConfig> contact = {};
  std::vector<RodPlace> contact_places = {};  ///< Which touch.
  std::optional<RodDragConfig> drag = {};
  struct Payload {
    RodPayload payload;
    double from = 0, until = 0;  ///< s
  };
  std::vector<Payload> payloads = {};
};

/// What a simulation needs to know of an arm and what moves it.
struct ArmSetup {
  /// The arm, its drive and its start as `config` says. Errors as arm_state() says (kinematics/shape.h).
  explicit ArmSetup(const RigConfig& config);

  Arm arm;
  ArmState initial;            ///< Where it starts, as the model or the truth has it.
  std::optional<Drive> drive;  ///< None: bends are moved as their own rates allow.
  std::optional<ArmRod> rod;   ///< Of an arm whose model is static or dynamic. None: its sections are arcs.
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
