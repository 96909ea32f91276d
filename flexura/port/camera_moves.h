#pragma once

#include <cstddef>
#include <string>

#include "flexura/camera/camera.h"
#include "flexura/port/outcome.h"
#include "flexura/port/rig_ports.h"

// Commands and readings of cameras that may have no head or no stage: one that is missing stands where the
// camera's configuration starts it, `optics` being the camera as it is believed to be.
namespace flexura {

/// Sends the head. Of a camera without one: taken where it stands there anyway, else refused, by its name.
[[nodiscard]] CommandOutcome command_head(const CameraPorts& ports, const Camera& optics,
                                          const HeadState& state);
/// The same of its stage.
[[nodiscard]] CommandOutcome command_stage(const CameraPorts& ports, const Camera& optics,
                                           const StageState& state);
/// Stops both, as far as there are any; the first fault of the two.
[[nodiscard]] CommandOutcome halt_camera(const CameraPorts& ports);
/// What head and stage say, and of what is missing where it stands; the first fault of the two. Not checked:
/// read_camera() is (port/rig_readings.h).
[[nodiscard]] Outcome<CameraStance> said_stance(const CameraPorts& ports, const Camera& optics);

/// Why a camera cannot be turned and zoomed, by its name; "": it has a head.
[[nodiscard]] std::string missing_head(const CameraPorts& ports);
/// Why it cannot be slid as far as it is believed to be: it is believed to have a stage with travel, and has
/// none; "" otherwise.
[[nodiscard]] std::string missing_stage(const CameraPorts& ports, const Camera& optics);

}  // namespace flexura
