#pragma once

#include <memory>
#include <string>
#include <vector>

#include "flexura/equipment/dry_devices.h"
#include "flexura/rig/rig.h"

namespace flexura {

/// Returns a rig that does what equipment_rig() does, without equipment. The drivers of the experiment's
/// table [rig] talk to simulated devices (DryDevices), and `take` receives every message that they send.
/// Pictures and the readings of arm and heads are those of the simulated rig. Time is simulated: 0 is the
/// start of the run, and the messages before it, of connecting and homing, have times below 0. The Setup must
/// outlive the rig. Throws std::runtime_error with one clear line if a driver refuses the file or a command.
[[nodiscard]] std::unique_ptr<Rig> dry_rig(const Setup& setup, const TakeDryMessage& take);

/// Returns what a dry run of this setup assumes about the devices, one sentence each.
[[nodiscard]] std::vector<std::string> dry_assumptions(const Setup& setup);

}  // namespace flexura
