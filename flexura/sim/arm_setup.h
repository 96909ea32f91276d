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

/// An arm as an elastic rod, with its loads and the settings of its motion.
struct ArmRod {
  Rod rod;
  RodLoads loads;
  std::vector<TendonBreak> breaks = {};
  /// Time step of the motion, s. Missing: the arm has no inertia, and the following fields are empty.
  std::optional<double> time_step = {};
  double spectral_radius = 0.1;  ///< Value of RodDynamicsConfig::spectral_radius.
  std::optional<RodContactConfig> contact = {};
  std::optional<RodDragConfig> drag = {};
  /// A mass that the arm carries temporarily.
  struct Payload {
    RodPayload payload;
    double from = 0, until = 0;  ///< Times at which the arm picks up and drops the payload, s.
  };
  std::vector<Payload> payloads = {};
};

/// An arm, its drive and its initial state, for a simulation.
struct ArmSetup {
  /// Builds the arm, its drive and its initial state from `config`. Throws the exceptions of arm_state()
  /// (kinematics/shape.h).
  explicit ArmSetup(const RigConfig& config);

  Arm arm;
  ArmState initial;            ///< Initial state.
  std::optional<Drive> drive;  ///< Drive of the arm; missing: the sections bend at their own rates.
  /// The rod of a static or dynamic arm; missing: sections are arcs.
  std::optional<ArmRod> rod;
};

}  // namespace flexura
