#pragma once

#include <string>
#include <utility>
#include <vector>

#include "flexura/rig/setup.h"

namespace flexura {

/// What a device of an experiment says about itself, or why it cannot be used.
struct DeviceReport {
  std::string name;    ///< What it is for: "motors 1 to 3", "front: pictures", "front: head".
  std::string driver;  ///< "Grbl", "CiA 402", "VISCA", "USB head", "GStreamer", "Aravis" or "V4L2".
  std::string place;   ///< Its address, as in the file.
  /// Properties and their values, as text with units.
  std::vector<std::pair<std::string, std::string>> facts = {};
  std::string problem = {};  ///< Why it cannot be used, one line; "" if it can.
};

/// Connects to every device of an experiment's equipment, and asks what it is and where it stands. Nothing
/// moves. Grbl controllers are reset and forget where the arm is; CANopen drives switch their motors on,
/// which hold. `camera_time`: time for which pictures are counted, s, > 0. A camera without pictures is
/// waited for, for `patience` s. Requires that the setup has equipment.
[[nodiscard]] std::vector<DeviceReport> report_devices(const Setup& setup, double camera_time = 1,
                                                       double patience = 10);

}  // namespace flexura
