#pragma once

#include <cstddef>
#include <string>

#include "flexura/camera/camera.h"
#include "flexura/port/outcome.h"
#include "flexura/port/rig_ports.h"

// Commands and readings of cameras that may lack a head or a stage. A camera without one stays at its initial
// axis positions. `optics` is the model of the camera.
namespace flexura {

/// Commands the head. Without a head, the camera's initial state is accepted, and any other is refused with
/// the camera's name.
[[nodiscard]] CommandOutcome command_head(const CameraPorts& ports, const Camera& optics,
                                          const HeadState& state);
/// Commands the stage. Without a stage, the camera's initial state is accepted, and any other is refused with
/// the camera's name.
[[nodiscard]] CommandOutcome command_stage(const CameraPorts& ports, const Camera& optics,
                                           const StageState& state);
/// Stops head and stage, if present. Returns the first fault.
[[nodiscard]] CommandOutcome halt_camera(const CameraPorts& ports);
/// Returns the axis positions that head and stage report; missing ones are at their initial positions.
/// Returns the first fault of the two. The positions are not checked, unlike those of read_camera()
/// (port/rig_readings.h).
[[nodiscard]] Outcome<CameraStance> measured_stance(const CameraPorts& ports, const Camera& optics);

/// Returns the reason why a camera cannot pan, tilt and zoom, with its name, or "" if it has a head.
[[nodiscard]] std::string missing_head(const CameraPorts& ports);
/// Returns the reason why a camera cannot be translated as in the model, or "" if it can. That is the case if
/// the model has a stage with travel and the camera has no stage.
[[nodiscard]] std::string missing_stage(const CameraPorts& ports, const Camera& optics);

}  // namespace flexura
