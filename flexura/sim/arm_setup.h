#pragma once

#include <optional>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_contact.h"
#include "flexura/mechanics/rod_drag.h"
#include "flexura/mechanics/surroundings.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"
#include "flexura/sim/rig_config.h"

namespace flexura {

/// The rod that an arm is, and what pulls at it beside its tendons.
struct ArmRod {
  Rod rod;
  RodLoads loads;
  std::vector<TendonBreak> breaks = {};
  std::optional<double> time_step = {};  ///< Of its motion, s. None: it has no inertia, and none of the next.
  std::optional<RodContactConfig> contact = {};
  std::optional<RodDragConfig> drag = {};
  /// A mass that it carries for a time.
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

}  // namespace flexura
