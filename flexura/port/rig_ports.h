#pragma once

#include <string>
#include <vector>

#include "flexura/port/camera_port.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

/// A camera of a rig with its moving devices. Without one, the camera stays at its initial axis positions.
/// Use port/camera_moves.h and port/rig_readings.h for any camera.
struct CameraPorts {
  std::string name;              ///< CameraConfig::name.
  CameraPort* camera = nullptr;  ///< Never null.
  HeadPort* head = nullptr;      ///< Null if the camera has no pan, tilt and zoom.
  StagePort* stage = nullptr;    ///< Null if the camera has no translation.
};

/// All ports of a rig, simulated or real. Owned by the rig; clock and arm are never null.
struct RigPorts {
  ClockPort* clock = nullptr;
  ArmPort* arm = nullptr;
  std::vector<CameraPorts> cameras;  ///< One or more, in the order in which tasks count them, from 0.
};

}  // namespace flexura
