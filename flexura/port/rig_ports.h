#pragma once

#include <string>
#include <vector>

#include "flexura/port/camera_port.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

/// A camera of a rig with its moving devices. The axes of a missing head or stage count as fixed at their
/// initial positions. The functions in port/camera_moves.h and port/rig_readings.h handle missing devices.
struct CameraPorts {
  std::string name;              ///< Name of the camera (CameraConfig::name).
  CameraPort* camera = nullptr;  ///< Source of frames; never null.
  HeadPort* head = nullptr;      ///< Pan/tilt/zoom head; null for a camera without head.
  StagePort* stage = nullptr;    ///< Stage that translates the head; null for a camera without stage.
};

/// All ports of a rig, simulated or real. The rig owns the ports. `clock` and `arm` are never null.
struct RigPorts {
  ClockPort* clock = nullptr;
  ArmPort* arm = nullptr;
  std::vector<CameraPorts> cameras;  ///< One or more cameras. Tasks refer to cameras by their index, from 0.
};

}  // namespace flexura
