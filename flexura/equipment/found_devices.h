#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "flexura/equipment/v4l2_calls.h"
#include "flexura/port/clock_port.h"

namespace flexura {

/// A device or an interface that this machine has.
struct FoundDevice {
  std::string kind;   ///< "serial line", "video device", "GigE or USB3 camera" or "CAN interface".
  std::string place;  ///< As a file names it: "/dev/ttyUSB0", "/dev/video0", "can:can0".
  std::string about;  ///< What it is and can do, one line; "" if unknown.
};

/// Folders of the system in which devices are found.
struct DeviceFolders {
  std::filesystem::path devices = "/dev";
  std::filesystem::path system = "/sys";
};

/// Returns the serial lines of USB and of the board, without opening any. Those under serial/by-id come with
/// this name, which stays the same.
[[nodiscard]] std::vector<FoundDevice> found_serial_lines(const DeviceFolders& folders = {});
/// Returns the interfaces of SocketCAN, with their states.
[[nodiscard]] std::vector<FoundDevice> found_can_interfaces(const DeviceFolders& folders = {});
/// Returns the video devices that give pictures, with their formats and sizes, and those that cannot be
/// opened. Opening one disturbs no other program.
[[nodiscard]] std::vector<FoundDevice> found_video_devices(
    const DeviceFolders& folders = {}, const std::shared_ptr<V4l2Calls>& calls = v4l2_system_calls());
/// Returns the GigE Vision and USB3 Vision cameras that Aravis finds.
[[nodiscard]] std::vector<FoundDevice> found_vision_cameras();

/// A driver that this build lacks.
struct MissingDriver {
  std::string driver;    ///< "gstreamer"
  std::string packages;  ///< Packages of Debian that the build needs.
};
[[nodiscard]] std::vector<MissingDriver> missing_drivers();

/// Asks what is at a link: a serial line, or an address tcp:HOST:PORT or udp:HOST:PORT. Asks for Grbl's build
/// (`$I`) and for a VISCA version; on a serial line without a speed, at 115200 and 9600 bits/s. Returns what
/// answers, or why nothing does.
///
/// Opening a serial line resets many boards (DTR), which stops their motors, and the bytes may mean something
/// else to a device of another kind. Throws std::invalid_argument if `address` is not an address.
[[nodiscard]] std::string probe_link(const std::string& address, ClockPort& clock);

}  // namespace flexura
