#pragma once

#include <memory>
#include <string>
#include <vector>

#include "flexura/equipment/dry_devices.h"
#include "flexura/rig/rig.h"

namespace flexura {

/// Returns a rig for a dry run. A dry run uses the same drivers as equipment_rig(), but the drivers
/// communicate with simulated devices (DryDevices). `take` receives every message that the drivers send. The
/// pictures and readings come from the simulated rig. Time is simulated, and time 0 is the start of the run.
/// Messages before the start, for example of homing, have times below 0. The Setup must outlive the rig.
/// Throws std::runtime_error with one clear line if a driver refuses the file or a command.
[[nodiscard]] std::unique_ptr<Rig> dry_rig(const Setup& setup, const TakeDryMessage& take);

/// Returns the assumptions about the devices in a dry run of this setup, one sentence each.
[[nodiscard]] std::vector<std::string> dry_assumptions(const Setup& setup);

}  // namespace flexura
