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

/// Pixel format of a video device. automatic: the first format of the device that fits the sensor.
enum class V4l2Format { automatic, grey, yuyv, rgb, mjpeg };

/// A camera of the kernel's interface Video4Linux2, for example a USB camera.
struct V4l2Config {
  std::string device = "/dev/video0";  ///< Path of the device; paths under /dev/v4l/by-id do not change.
  V4l2Format format = V4l2Format::automatic;
  std::optional<double> exposure =
      {};  ///< Exposure time, s, in steps of 0.1 ms; default: as set in the camera.
  std::optional<std::int64_t> gain = {};  ///< Gain in the camera's unit; default: as set in the camera.
  double silence = 5;        ///< Time without a frame after which the program reopens the device, s.
  double longest_pause = 5;  ///< Longest pause before the program reopens the device, s.
};

const std::vector<std::string>& names_of(const V4l2Format*);
const Table<V4l2Config>& fields_of(const V4l2Config*);

/// Starts a camera with the size, channels and frame rate of `camera.sensor`. A thread opens the device, and
/// reopens it after a loss. Lost frames are counted by the driver's sequence numbers.
///
/// Frame::time is the driver's time stamp, or the middle of the exposure if the exposure time is known. Most
/// drivers use this machine's monotonic clock (steady_seconds()). Use ClockedCamera for times on the rig's
/// clock.
///
/// `clock` must outlive the camera. Returns a fault for a sensor with more than 8 bits.
[[nodiscard]] Outcome<std::unique_ptr<CountedCamera>> open_v4l2_camera(
    const V4l2Config& config, const CameraConfig& camera, const ClockPort& clock,
    const std::shared_ptr<V4l2Calls>& calls = v4l2_system_calls());

}  // namespace flexura
