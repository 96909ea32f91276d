#pragma once

#include <memory>

#include "flexura/rig/rig.h"
#include "flexura/rig/setup.h"

namespace flexura {

/// Returns the rig of the equipment in the experiment's table [rig]. It connects to all devices, finds out where
/// the motors are (RigEquipment::start) and starts the process that stops devices when this program dies or hangs.
/// In the end it stops all devices. Its clock shows real time.
///
/// Throws std::runtime_error with one clear line if a device cannot be used, or, later, if a device fails.
[[nodiscard]] std::unique_ptr<Rig> equipment_rig(const Setup& setup);

/// Returns the rig of an experiment: its equipment if it has a table [rig], otherwise a simulated rig.
[[nodiscard]] std::unique_ptr<Rig> rig_of(const Setup& setup);

}  // namespace flexura
