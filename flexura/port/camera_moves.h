#pragma once

#include <cstddef>
#include <string>

#include "flexura/camera/camera.h"
#include "flexura/port/outcome.h"
#include "flexura/port/rig_ports.h"

// Commands and readings of cameras, with or without head and stage. The axes of a missing head or stage count
// as fixed at their initial positions. `optics` is the model of the camera.
namespace flexura {

/// Commands the head. A camera without a head accepts only its initial head position. Such a camera refuses
/// other positions with a message that contains the camera's name.
[[nodiscard]] CommandOutcome command_head(const CameraPorts& ports, const Camera& optics,
                                          const HeadState& state);
/// Commands the stage. A camera without a stage accepts only its initial stage position. Such a camera
/// refuses other positions with a message that contains the camera's name.
[[nodiscard]] CommandOutcome command_stage(const CameraPorts& ports, const Camera& optics,
                                           const StageState& state);
/// Stops head and stage, if present. Returns the first fault, if any.
[[nodiscard]] CommandOutcome halt_camera(const CameraPorts& ports);
/// Returns the axis positions that head and stage report, or the first fault. Axes of a missing head or stage
/// are at their initial positions. The positions are not checked; read_camera() (port/rig_readings.h) returns
/// checked positions.
[[nodiscard]] Outcome<CameraStance> measured_stance(const CameraPorts& ports, const Camera& optics);

/// Returns a message with the camera's name if the camera has no head for pan, tilt and zoom, otherwise "".
[[nodiscard]] std::string missing_head(const CameraPorts& ports);
/// Returns a message with the camera's name if the model has a stage with travel but the camera has no stage,
/// otherwise "".
[[nodiscard]] std::string missing_stage(const CameraPorts& ports, const Camera& optics);

}  // namespace flexura
