#pragma once

#include <cstddef>
#include <string>
#include <variant>

#include "flexura/camera/camera.h"
#include "flexura/port/rig_model.h"
#include "flexura/port/rig_ports.h"

namespace flexura {

/// Where a camera's head and stage say that it stands.
struct StanceReading {
  double time = 0;  ///< s, of the head's; without one of the stage's, without either of the clock's.
  RigStance stance;
  bool moving = false;  ///< One of them.
};

/// What the drives of an arm of so many sections say; or in words why that is no state of it: a fault, a
/// number that is none, another number of sections.
[[nodiscard]] std::variant<ArmReading, std::string> read_arm(ArmPort& arm, std::size_t sections);

/// What the head and the stage of the rig's camera number `camera` say; or in words why that tells no view of
/// it: a fault, a number that is none, a zoom beyond the ends of what is known of the lens. A zoom within a
/// step of an end is that end. `optics` are of that camera as it is believed to be: where it starts, it
/// stands without a head or a stage.
[[nodiscard]] std::variant<StanceReading, std::string> read_camera(const RigPorts& rig, std::size_t camera,
                                                                   const Camera& optics);

}  // namespace flexura
