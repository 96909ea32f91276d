#pragma once

#include <cstddef>
#include <string>
#include <variant>

#include "flexura/camera/camera.h"
#include "flexura/port/rig_model.h"
#include "flexura/port/rig_ports.h"

namespace flexura {

/// Reading of a camera's axis positions.
struct StanceReading {
  /// Time of the head's reading, s; without a head, of the stage's reading; without both, the current time.
  double time = 0;
  RigStance stance;
  bool moving = false;  ///< Whether head or stage is moving.
};

/// Returns the reading of an arm with this number of sections, or an error message. Errors are a fault, a
/// number that is not finite, and a wrong number of sections.
[[nodiscard]] std::variant<ArmReading, std::string> read_arm(ArmPort& arm, std::size_t sections);

/// Returns the reading of head and stage of the rig's camera with index `camera`, or an error message. Errors
/// are a fault, a number that is not finite, and a zoom outside the lens's table. A zoom that is outside the
/// table by up to one resolution step is clamped to the table. `optics`: model of this camera. The initial
/// positions of the model replace readings of a missing head or stage.
[[nodiscard]] std::variant<StanceReading, std::string> read_camera(const RigPorts& rig, std::size_t camera,
                                                                   const Camera& optics);

}  // namespace flexura
