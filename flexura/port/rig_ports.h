#pragma once

#include <string>
#include <vector>

#include "flexura/port/camera_port.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

/// A camera of a rig with what moves it. Never null.
struct CameraPorts {
  std::string name;  ///< CameraConfig::name
  CameraPort* camera = nullptr;
  HeadPort* head = nullptr;
  StagePort* stage = nullptr;
};

/// All that a task can do to a rig and see of it, whether it is simulated or real. Owned by the rig.
struct RigPorts {
  ClockPort* clock = nullptr;
  ArmPort* arm = nullptr;
  std::vector<CameraPorts> cameras;  ///< In the order in which tasks count them, from 0.
};

}  // namespace flexura
