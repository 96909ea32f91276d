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

/// A GigE Vision or USB3 Vision camera, through Aravis.
struct AravisConfig {
  /// The camera's name as `arv-tool-0.8` lists it, or the address of a GigE Vision camera; "": the first that
  /// is found.
  std::string device;
  std::optional<double> exposure = {};  ///< Exposure time, s, > 0; default: as set in the camera.
  std::optional<double> gain = {};  ///< Gain in the camera's unit, mostly dB; default: as set in the camera.
  std::int64_t packet_size =
      0;  ///< Size of GigE Vision packets, bytes; 0: the largest that the network takes.
  /// Whether GigE Vision packets are taken from the network interface directly if this program has the right
  /// to (CAP_NET_RAW), which needs less time. Not for a camera on the same machine.
  bool packet_socket = true;
  double silence = 5;        ///< Time without a frame after which the connection is made again, s.
  double longest_pause = 5;  ///< Longest pause before a new connection, s.
};

const Table<AravisConfig>& fields_of(const AravisConfig*);

/// Returns whether this program was built with Aravis.
[[nodiscard]] bool has_aravis();

/// Returns the names of the cameras that Aravis finds, with their addresses; waits for answers of the
/// network. Empty without Aravis.
[[nodiscard]] std::vector<std::string> aravis_cameras();

/// Starts a camera with the size, channels and frame rate of `camera.sensor`: Mono8 or RGB8. The image is in
/// the middle of the camera's sensor if it is smaller. The connection is made, and made again, in the
/// background. The camera's own numbers count lost frames.
///
/// Frame::time is the camera's time stamp, taken as the start of the exposure, plus half of the exposure time
/// that the camera reports. Use ClockedCamera for times on the rig's clock.
///
/// `clock` must outlive the camera. Refuses a sensor with more than 8 bits, and every camera if the program
/// was built without Aravis.
[[nodiscard]] Outcome<std::unique_ptr<CountedCamera>> open_aravis_camera(const AravisConfig& config,
                                                                         const CameraConfig& camera,
                                                                         const ClockPort& clock);

}  // namespace flexura
