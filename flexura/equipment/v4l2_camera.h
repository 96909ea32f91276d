#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/fields.h"
#include "flexura/camera/camera_config.h"
#include "flexura/equipment/camera_feed.h"
#include "flexura/equipment/v4l2_calls.h"

namespace flexura {

/// Pixel format of a video device. automatic: the first that it has of those that fit the sensor.
enum class V4l2Format { automatic, grey, yuyv, rgb, mjpeg };

/// A camera of the kernel's video interface, for example a USB camera.
struct V4l2Config {
  std::string device = "/dev/video0";  ///< Path; those under /dev/v4l/by-id stay the same.
  V4l2Format format = V4l2Format::automatic;
  std::optional<double> exposure =
      {};  ///< Exposure time, s, in steps of 0.1 ms; default: as set in the camera.
  std::optional<std::int64_t> gain = {};  ///< Gain in the camera's unit; default: as set in the camera.
  double silence = 5;                     ///< Time without a frame after which the device is opened again, s.
  double longest_pause = 5;               ///< Longest pause before the device is opened again, s.
};

const std::vector<std::string>& names_of(const V4l2Format*);
const Table<V4l2Config>& fields_of(const V4l2Config*);

/// Starts a camera with the size, channels and frame rate of `camera.sensor`. The device is opened, and
/// opened again after a loss, in the background. The driver's sequence numbers count lost frames.
///
/// Frame::time is the driver's time stamp, moved to the middle of the exposure if that is known. Most drivers
/// use this machine's monotonic clock (steady_seconds()). Use ClockedCamera for times on the rig's clock.
///
/// `clock` must outlive the camera. Refuses a sensor with more than 8 bits.
[[nodiscard]] Outcome<std::unique_ptr<CountedCamera>> open_v4l2_camera(
    const V4l2Config& config, const CameraConfig& camera, const ClockPort& clock,
    const std::shared_ptr<V4l2Calls>& calls = v4l2_system_calls());

}  // namespace flexura
