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

/// What a frame shows: all that a take_picture needs to know of it.
struct Shot {
  std::size_t camera = 0;                    ///< Its place in the rig.
  std::int64_t frame = 0;                    ///< With the seed and the camera: the key of its noise.
  std::uint64_t seed = 0;                    ///< Of the run.
  double start = 0;                          ///< When the exposure of the first row starts, s.
  const SensorConfig* sensor = nullptr;      ///< How long it lasts, and how the rows follow. Never null.
  std::function<View(double)> view;          ///< From start on: what the camera sees at a time,
  std::function<Backbone(double)> backbone;  ///< and where the arm is.
  bool is_covered = false;                   ///< Something stands before the lens: there is no light.
};

/// Makes the image of a shot, of the sensor's size, channels and bits. The same image for the same shot.
using TakePicture = std::function<Picture(const Shot&)>;

/// The newest frames that `SimulatedCamera::newest` looks at: where more than these were lost in a row, it
/// has none.
inline constexpr int frames_kept = 16;

/// How long after the start of its exposure a frame can still be asked for, s: how far back views and
/// backbones must be known.
[[nodiscard]] double frame_horizon(const SensorConfig& sensor);

/// A camera that exposes frames at its rate from time 0 on, delays and loses them. Nothing is rendered but
/// what is asked for. Several cameras of a rig can be asked at once, each by a thread of its own, while
/// nobody waits for the clock or commands: their takers of pictures must bear that.
class SimulatedCamera : public CameraPort {
 public:
  /// `shot` says what its frames show; its frame, its start and whether it is covered are filled in for each.
  SimulatedCamera(const Camera& camera, Shot shot, TakePicture take_picture, ClockPort& clock);

  Outcome<std::optional<Frame>> newest() override;
  Outcome<std::optional<Frame>> wait(double timeout) override;

  /// Every frame that can be had now and was neither given nor passed over, from the oldest on, whatever the
  /// link does: for who films, not for algorithms.
  [[nodiscard]] std::vector<Frame> all_new();
  /// Whether there is one.
  [[nodiscard]] bool has_new() const;
  /// None of those is given any more.
  void skip_to_now() { next_ = last_received(clock_->now()) + 1; }

  /// What connects the camera: it can be lost for a time.
  [[nodiscard]] SimulatedLink& link() { return link_; }

 private:
  [[nodiscard]] bool is_lost(std::int64_t frame) const;
  [[nodiscard]] std::int64_t last_received(double time) const;
  [[nodiscard]] Frame take(std::int64_t number);

  SimulatedLink link_;
  SensorConfig sensor_;
  Shot shot_;
  TakePicture take_picture_;
  ClockPort* clock_;
  std::int64_t next_ = 0;  // the first frame that was not passed over
};

}  // namespace flexura
