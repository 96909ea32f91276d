#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/model/backbone.h"
#include "flexura/port/camera_port.h"
#include "flexura/port/clock_port.h"
#include "flexura/sim/simulated_link.h"

namespace flexura {

/// Data that a TakePicture function needs to render a frame.
struct Shot {
  std::size_t camera = 0;  ///< Index of the camera in the rig.
  /// Number of the frame. Seed, camera and frame number together determine the noise.
  std::int64_t frame = 0;
  std::uint64_t seed = 0;                    ///< Seed of the run.
  double start = 0;                          ///< Start of the exposure of the first row, s.
  const SensorConfig* sensor = nullptr;      ///< Exposure time and row timing. Never null.
  std::function<View(double)> view;          ///< Returns the camera's view at a time from `start` on.
  std::function<Backbone(double)> backbone;  ///< Returns the arm's backbone at a time from `start` on.
  bool is_covered = false;                   ///< Whether the lens is covered, so that there is no light.
};

/// Renders the image of a shot with the sensor's size, channels and bits. Equal shots must give equal images.
using TakePicture = std::function<Picture(const Shot&)>;

/// Number of frames that `SimulatedCamera::newest` examines, beginning with the newest. If all these frames
/// were lost, `newest` returns no frame.
inline constexpr int frames_kept = 16;

/// Returns the longest time between the start of a frame's exposure and the last possible request for this
/// frame, s. Views and backbones must be available for this time in the past.
[[nodiscard]] double frame_horizon(const SensorConfig& sensor);

/// A camera that exposes frames at its frame rate from time 0, delays frames and loses some frames. A
/// SimulatedCamera renders only requested frames. Several cameras of a rig can be queried at once, each from
/// its own thread, if the TakePicture functions are thread-safe. Meanwhile, no thread may wait for the clock
/// or send commands.
class SimulatedCamera : public CameraPort {
 public:
  /// `shot` describes the content of the frames. The camera sets its members `frame`, `start` and
  /// `is_covered` for each frame.
  SimulatedCamera(const Camera& camera, Shot shot, TakePicture take_picture, ClockPort& clock);

  Outcome<std::optional<Frame>> newest() override;
  Outcome<std::optional<Frame>> wait(double timeout) override;

  /// Returns all available frames that were neither returned nor skipped, the oldest first, even if the link
  /// is interrupted. This function is meant for recording, not for algorithms.
  [[nodiscard]] std::vector<Frame> all_new();
  /// Returns whether all_new() would return a frame.
  [[nodiscard]] bool has_new() const;
  /// Returns whether a frame is lost on its way. Callable in any thread.
  [[nodiscard]] bool is_lost(std::int64_t frame) const;
  /// Skips all frames available now.
  void skip_to_now() { next_ = last_received(clock_->now()) + 1; }

  /// Returns the link to the camera. The link can be interrupted temporarily.
  [[nodiscard]] SimulatedLink& link() { return link_; }

 private:
  [[nodiscard]] std::int64_t last_received(double time) const;
  [[nodiscard]] Frame take(std::int64_t number);

  SimulatedLink link_;
  SensorConfig sensor_;
  Shot shot_;
  TakePicture take_picture_;
  ClockPort* clock_;
  std::int64_t next_ = 0;  // The first frame that was not skipped.
};

}  // namespace flexura
