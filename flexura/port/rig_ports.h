#pragma once

#include <string>
#include <vector>

#include "flexura/port/camera_port.h"
#include "flexura/port/clock_port.h"
#include "flexura/port/motion_ports.h"

namespace flexura {

/// A camera of a rig with what moves it. What moves it may be missing: it then stands where its configuration
/// starts it. port/camera_moves.h and port/rig_readings.h ask and tell all cameras alike.
struct CameraPorts {
  std::string name;              ///< CameraConfig::name
  CameraPort* camera = nullptr;  ///< Never null.
  HeadPort* head = nullptr;      ///< Null: the camera is neither turned nor zoomed.
  StagePort* stage = nullptr;    ///< Null: it is not slid.
};

/// All that a task can do to a rig and see of it, whether it is simulated or real. Owned by the rig; clock
/// and arm are never null.
struct RigPorts {
  ClockPort* clock = nullptr;
  ArmPort* arm = nullptr;
  std::vector<CameraPorts> cameras;  ///< One or more, in the order in which tasks count them, from 0.
};

}  // namespace flexura
