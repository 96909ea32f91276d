#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "flexura/equipment/v4l2_calls.h"
#include "flexura/port/clock_port.h"

namespace flexura {

/// A device or an interface of this computer.
struct FoundDevice {
  std::string kind;   ///< "serial line", "video device", "GigE or USB3 camera" or "CAN interface".
  std::string place;  ///< Address as written in files: "/dev/ttyUSB0", "/dev/video0", "can:can0".
  std::string about;  ///< Description of the device in one line; "" if unknown.
};

/// Folders of the system that list devices.
struct DeviceFolders {
  std::filesystem::path devices = "/dev";
  std::filesystem::path system = "/sys";
};

/// Returns the serial lines (USB and on-board), without opening them. Lines under serial/by-id have this
/// name, which does not change.
[[nodiscard]] std::vector<FoundDevice> found_serial_lines(const DeviceFolders& folders = {});
/// Returns the interfaces of SocketCAN, with their states.
[[nodiscard]] std::vector<FoundDevice> found_can_interfaces(const DeviceFolders& folders = {});
/// Returns the video devices that deliver pictures, with their formats and sizes, and the video devices that
/// cannot be opened. Opening a video device does not disturb other programs.
[[nodiscard]] std::vector<FoundDevice> found_video_devices(
    const DeviceFolders& folders = {}, const std::shared_ptr<V4l2Calls>& calls = v4l2_system_calls());
/// Returns the GigE Vision and USB3 Vision cameras that Aravis finds.
[[nodiscard]] std::vector<FoundDevice> found_vision_cameras();

/// A driver that is missing in this build.
struct MissingDriver {
  std::string driver;    ///< "gstreamer"
  std::string packages;  ///< Debian packages that a build with this driver needs.
};
[[nodiscard]] std::vector<MissingDriver> missing_drivers();

/// Finds out which device is at an address: a serial line, tcp:HOST:PORT or udp:HOST:PORT. Asks for the build
/// of Grbl (`$I`) and for a VISCA version. A serial line without a given speed is tried at 115200 and 9600
/// bits/s. Returns a description of the device that answers, or the reason why no device answers.
///
/// Opening a serial line resets many boards (DTR), which stops their motors. Devices of another kind may
/// misinterpret the bytes. Throws std::invalid_argument if `address` is not an address.
[[nodiscard]] std::string probe_link(const std::string& address, ClockPort& clock);

}  // namespace flexura
