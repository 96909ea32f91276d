#pragma once

#include <optional>
#include <string>

#include "flexura/camera/camera.h"
#include "flexura/experiment/experiment.h"
#include "flexura/log/recorder.h"
#include "flexura/log/scene_messages.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Returns the objects around the arm at the start of a run: screens, etalon, obstacles.
[[nodiscard]] SceneMessage stand_message(const Experiment& experiment);

/// Returns the poses of the arm's base ("base") and the cameras' optical frames ("camera/NAME") at the start.
/// Also returns the frame "upright", the world with its Y as z, for programs that draw z upwards.
[[nodiscard]] FramesMessage frames_message(const Experiment& experiment);

/// Returns a camera's lens at its zoom, as a message for `time`, s.
[[nodiscard]] CameraCalibrationMessage calibration_message(const Camera& camera, double time, double zoom);

/// Logs one camera's lens and the pose of its optical frame, for programs that display logs. Logs lens and
/// pose at the start and after changes, at most once per frame of the camera.
class CameraDrawing {
 public:
  /// `camera`: the true camera. `model`: the camera's model; reported axis positions are relative to the
  /// model's start. Logs the lens at the start; the pose at the start is in frames_message.
  CameraDrawing(const CameraConfig& camera, const CameraConfig& model, Recorder& recorder);

  [[nodiscard]] const std::string& name() const { return camera_.config().name; }
  /// Returns the axis positions that the camera reports at the start.
  [[nodiscard]] const CameraStance& first_report() const { return first_report_; }
  /// Logs the lens and the pose if they differ from the last logged ones. `reported`: axis positions at
  /// `time`, s.
  void report(double time, const CameraStance& reported, Recorder& recorder);

 private:
  void log_lens(double time, double zoom, Recorder& recorder);

  Camera camera_;
  CameraStance first_report_;
  CameraStance logged_;   // True.
  double logged_at_ = 0;  // s
};

/// Returns the arm along `backbone` as polylines. Each polyline has the mean thickness of its section,
/// rounded to micrometres.
[[nodiscard]] SceneMessage arm_message(const ColorConfig& color, double time, const Backbone& backbone);

/// Selects the states to draw: the first state, then ten per second of simulated time.
class SceneTimes {
 public:
  /// Returns true if the state at `time` (s) is selected. The times of successive calls must increase.
  [[nodiscard]] bool is_next(double time);

 private:
  std::optional<double> last_;
};

}  // namespace flexura
