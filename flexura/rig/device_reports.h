#pragma once

#include <string>
#include <utility>
#include <vector>

#include "flexura/rig/setup.h"

namespace flexura {

/// Properties that a device of an experiment reports, or the reason why the device cannot be used.
struct DeviceReport {
  std::string name;    ///< Purpose of the device: "motors 1 to 3", "front: pictures", "front: head".
  std::string driver;  ///< "Grbl", "CiA 402", "VISCA", "USB head", "GStreamer", "Aravis" or "V4L2".
  std::string place;   ///< Address of the device, as in the file.
  /// Properties and their values, as text with units.
  std::vector<std::pair<std::string, std::string>> facts = {};
  std::string problem = {};  ///< Reason why the device cannot be used, one line; "" if it can be used.
};

/// Connects to every device of an experiment's equipment, and reads its properties and its position. Nothing
/// moves. Grbl controllers are reset, after which their positions are unknown. CANopen drives switch their
/// motors on, which then hold their positions. `camera_time`: time for which pictures are counted, s, > 0.
/// `patience`: longest wait for the first picture of a camera, s. Requires that the setup has equipment.
[[nodiscard]] std::vector<DeviceReport> report_devices(const Setup& setup, double camera_time = 1,
                                                       double patience = 10);

}  // namespace flexura
