#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/port/rig_model.h"
#include "flexura/port/rig_ports.h"
#include "flexura/servo/motion_history.h"

namespace flexura {

/// Two simultaneous pictures and the cameras' nominal views at that time.
struct PicturePair {
  std::array<Frame, 2> frames;
  std::array<View, 2> views;

  /// Returns the middle of the exposures, s.
  [[nodiscard]] double time() const { return 0.5 * (frames[0].time + frames[1].time); }
};

/// Reads a rig's devices: the newest two simultaneous pictures, and the readings of arm, heads and stages at
/// the time of the pictures.
class RigReader {
 public:
  struct Times {
    double span = 0;      ///< Time for which readings are kept, s.
    double together = 0;  ///< Largest time difference between two pictures that count as simultaneous, s.
    double silent = 0;    ///< Age of a reading beyond which the device counts as silent, s.
  };
  /// `nominal` must outlive this object.
  RigReader(const RigPorts& ports, const RigModel& nominal, const std::array<std::size_t, 2>& cameras,
            const Times& times);

  using Error = std::optional<std::string>;
  /// Reads arm, heads and stages. Returns an error if a reading is missing (rig_readings.h) or too old, or if
  /// its time is in the future.
  [[nodiscard]] Error read();
  /// Requests pictures from the cameras. Returns a new pair of pictures, if there is one. A picture is
  /// refused if its timestamp is not finite, in the future, or out of order. If a camera did not answer, or
  /// the reader refused its picture, silence() returns the reason.
  [[nodiscard]] std::optional<PicturePair> newest_pair();
  /// If a camera delivered no picture at the last request, returns the camera's name with the reason;
  /// otherwise "".
  [[nodiscard]] std::string silence() const;
  /// Returns the reason why there is no pair of pictures. Names the cameras without a picture since the time
  /// `since`, s.
  [[nodiscard]] std::string no_pair(double since) const;

  /// measured() returns the measured position of the drives at a time, in terms of a command. nominal()
  /// returns the model's shape for this position.
  [[nodiscard]] ArmState measured(double time) const { return *arm_.at(time); }
  [[nodiscard]] ArmState nominal(double time) const { return model_.bent(measured(time)); }
  /// Returns the times of the drives' readings after `from` and before `to`, s, in order.
  [[nodiscard]] std::vector<double> readings_between(double from, double to) const {
    return arm_.times_between(from, to);
  }
  /// Returns the time of the drives' newest reading, s.
  [[nodiscard]] double newest_reading() const { return arm_.newest(); }
  /// Returns the nominal views of the cameras at a time.
  [[nodiscard]] std::array<View, 2> views(double time) const { return {view(0, time), view(1, time)}; }
  /// Returns the axis positions that the head and stage of camera i reported for `time`, s.
  [[nodiscard]] CameraStance stance(std::size_t i, double time) const { return *stances_[i].at(time); }

  [[nodiscard]] double now() const { return ports_.clock->now(); }
  [[nodiscard]] const RigPorts& ports() const { return ports_; }
  /// Returns the port of one of the two cameras.
  [[nodiscard]] const CameraPorts& camera(std::size_t i) const { return ports_.cameras[cameras_[i]]; }
  [[nodiscard]] const std::string& name(std::size_t i) const { return camera(i).name; }
  /// Returns `reason` with the estimator's picture numbers replaced by the cameras' names.
  [[nodiscard]] std::string by_name(std::string reason) const;

 private:
  using StateBlend = ArmState (*)(const ArmState&, const ArmState&, double);
  using StanceBlend = CameraStance (*)(const CameraStance&, const CameraStance&, double);
  [[nodiscard]] View view(std::size_t i, double time) const { return optics_[i].view(stance(i, time)); }
  // Check the time of a device's reading, and of a frame after the previous ones. Empty if the time is valid.
  [[nodiscard]] Error invalid_time(const std::string& device, double time) const;
  [[nodiscard]] std::string invalid_time(const Frame& frame, const std::deque<Frame>& before) const;
  // Requests a frame from both cameras.
  void take_newest();

  RigPorts ports_;
  const RigModel& model_;
  std::array<std::size_t, 2> cameras_;
  std::array<Camera, 2> optics_;  // Nominal cameras.
  Times times_;
  MotionHistory<ArmState, StateBlend> arm_;
  std::array<MotionHistory<CameraStance, StanceBlend>, 2> stances_;
  std::array<std::deque<Frame>, 2> recent_;
  std::array<double, 2> paired_at_ = {-1, -1};  // Times of the last pair's frames, s.
  std::array<std::string, 2> silence_;
};

}  // namespace flexura
