#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "flexura/equipment/device_server.h"
#include "flexura/equipment/grbl_device.h"

namespace flexura {

// An arm of one section with three tendons, a camera that shows a test picture, and a move of `duration` s.
inline std::string lab_file(const std::string& link, double duration, const std::string& rest = "") {
  return fmt::format(R"(
[arm]
kind = "spatial"
[[arm.section]]
length = 0.3
[drive]
radius = 0.01
[[drive.tendon]]
section = 1
angle_deg = 0
[[drive.tendon]]
section = 1
angle_deg = 120
[[drive.tendon]]
section = 1
angle_deg = 240
[[camera]]
name = "front"
lens.fx = 400
sensor.width = 160
sensor.height = 120
mount.position = [0, 0.1, 1]
mount.look_at = [0, 0, 0.1]
[record]
report = false
[[task]]
kind = "move"
duration = {1}
to.bends = [[0.3, 0.2]]
[rig]
watchdog = 0.2
[[rig.grbl]]
link = "{0}"
[[rig.camera]]
name = "front"
gstreamer.source = "videotestsrc is-live=true ! video/x-raw,width=160,height=120"
{2}
)",
                     link, duration, rest);
}

// A simulated controller on a serial line.
struct Controller {
  explicit Controller(GrblDeviceConfig config = quick_controller())
      : Controller(open_serial_pair(), std::move(config)) {}
  Controller(SerialPair pair, GrblDeviceConfig config)
      : device(std::move(config)),
        path(pair.path),
        kept(std::move(pair.kept)),
        server(std::move(pair.device), device) {}
  static GrblDeviceConfig quick_controller() {
    GrblDeviceConfig config;
    config.settings = {{100, 100}, {101, 100}, {102, 100}, {110, 6000}, {111, 6000}, {112, 6000}};
    return config;
  }
  std::vector<double> positions() {
    const auto lock = server.lock();
    return device.positions(DeviceServer::now());
  }
  GrblDevice device;
  std::string path;
  Descriptor kept;
  DeviceServer server;
};

}  // namespace flexura
