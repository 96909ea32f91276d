#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/photographer.h"
#include "flexura/experiment/run_watcher.h"
#include "flexura/experiment/schedule.h"
#include "flexura/experiment/truth_files.h"
#include "flexura/model/backbone.h"
#include "flexura/port/camera_port.h"
#include "flexura/port/rig_model.h"
#include "flexura/port/rig_ports.h"
#include "flexura/sim/crew.h"
#include "flexura/sim/simulated_rig.h"

namespace flexura {

/// A frame that was filmed.
struct FilmedFrame {
  std::string camera;
  Frame frame;
  std::string message;  ///< Its logged_image.
};

/// Plays an experiment's motion on its simulated rig and hands out the frames that its cameras deliver on the
/// way. The same frames, whatever number of threads draws them.
class Filming {
 public:
  /// One thread a camera.
  explicit Filming(const Experiment& experiment);
  Filming(const Experiment& experiment, std::size_t threads);

  using TakeFrame = std::function<void(const FilmedFrame&)>;

  /// Commands the arm to be in `state` at `time` s, not before the call's before, and gives every frame
  /// received until then, in the order of time and then of the cameras. Those that cameras deliver during one
  /// call are drawn at the same time.
  void play_to(double time, const ArmState& state, const TakeFrame& take);

  /// The same, and no frame is taken on the way.
  void pass_to(double time, const ArmState& state);
  /// Frames received up to now are not handed out any more.
  void skip_to_now();

  /// Where a camera of the simulated world truly stands: not for algorithms.
  [[nodiscard]] RigStance true_stance(std::size_t camera);

  /// The arm as it truly is, and stood at a time not long ago, s: likewise.
  [[nodiscard]] Backbone true_backbone(double time) { return rig_.arm().backbone(time); }

  /// The rig that plays; its clock is at the last call's time.
  [[nodiscard]] RigPorts ports() { return rig_.ports(); }

  /// Where the cameras say that they stand now.
  [[nodiscard]] std::vector<CameraReading> camera_readings();

  /// Plays `schedule` from its start to its first step at `until` s or later, to its end, or to the last step
  /// before a state that no arm can take, and renders nothing. Returns the time of that step, s.
  [[nodiscard]] double play_unfilmed(double until, const Schedule& schedule);

  /// What the camera in this place would expose from `start` s on, up to which the motion must have been
  /// played; at the start of a frame, that frame.
  [[nodiscard]] Shot shot(std::size_t camera, double start);
  [[nodiscard]] Picture take(const Shot& shot) { return photographers_[shot.camera]->take(shot); }
  /// What stands before the camera of `shot` at a time since its start.
  [[nodiscard]] ShownScene shown(const Shot& shot, double time) const {
    return {photographers_[shot.camera]->scene(shot.backbone(time)), shot.view(time)};
  }

 private:
  [[nodiscard]] std::vector<FilmedFrame> new_frames();

  std::vector<CameraConfig> cameras_;
  std::vector<std::unique_ptr<Photographer>> photographers_;  // each camera's own: they draw at the same time
  SimulatedRig rig_;
  std::uint64_t seed_;
  double stretch_;  // of time that is filmed at once, s: a few frames of the fastest camera
  Crew crew_;
};

}  // namespace flexura
