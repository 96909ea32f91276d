#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/camera_config.h"
#include "flexura/equipment/camera_feed.h"

namespace flexura {

/// A GigE Vision or USB3 Vision camera that is read with the library Aravis.
struct AravisConfig {
  /// The camera's name as `arv-tool-0.8` lists it, or the address of a GigE Vision camera; "": the first
  /// camera found.
  std::string device;
  std::optional<double> exposure = {};  ///< Exposure time, s, > 0; default: as set in the camera.
  std::optional<double> gain = {};  ///< Gain in the camera's unit, mostly dB; default: as set in the camera.
  std::int64_t packet_size =
      0;  ///< Size of GigE Vision packets, bytes; 0: the largest size that the network supports.
  /// Whether the program reads GigE Vision packets directly from the network interface, if it has the
  /// permission (CAP_NET_RAW). Direct reading needs less computing time. Use false for a camera that is
  /// simulated on this computer.
  bool packet_socket = true;
  double silence = 5;        ///< Time without a frame after which the program reconnects, s.
  double longest_pause = 5;  ///< Longest pause between two attempts to connect, s.
};

const Table<AravisConfig>& fields_of(const AravisConfig*);

/// Returns whether this program was built with Aravis.
[[nodiscard]] bool has_aravis();

/// Returns the names and addresses of the cameras that Aravis finds. The function waits for answers from the
/// network. Without Aravis the result is empty.
[[nodiscard]] std::vector<std::string> aravis_cameras();

/// Starts a camera with the size, channels and frame rate of `camera.sensor`: Mono8 or RGB8. If the image is
/// smaller than the camera's sensor, the image shows the middle of the sensor. A thread connects, and
/// reconnects after a loss. Lost frames are counted by the camera's frame numbers.
///
/// Frame::time is the camera's time stamp plus half of the exposure time that the camera reports. This
/// assumes that the time stamp is the start of the exposure. Use ClockedCamera for times on the rig's clock.
///
/// `clock` must outlive the camera. Returns a fault for a sensor with more than 8 bits, and for every camera
/// if the program was built without Aravis.
[[nodiscard]] Outcome<std::unique_ptr<CountedCamera>> open_aravis_camera(const AravisConfig& config,
                                                                         const CameraConfig& camera,
                                                                         const ClockPort& clock);

}  // namespace flexura
