#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/port/rig_ports.h"
#include "flexura/sim/rig_config.h"
#include "flexura/sim/simulated_arm.h"
#include "flexura/sim/simulated_camera.h"
#include "flexura/sim/simulated_clock.h"
#include "flexura/sim/simulated_head.h"
#include "flexura/sim/true_plant.h"

namespace flexura {

/// A camera of the simulated world with its head and stage.
class SimulatedView {
 public:
  /// `config` is the true camera. The counters of its head and stage start at the initial state of the camera
  /// model `nominal`. `shot` and `take_picture` as for SimulatedCamera; the shot's `view` is set here.
  SimulatedView(const CameraConfig& nominal, const CameraConfig& config, Shot shot,
                const TakePicture& take_picture, SimulatedClock& clock, double horizon);

  /// Returns the true camera.
  [[nodiscard]] const Camera& description() const { return description_; }
  /// Returns the true axis positions at `time` s; not for algorithms.
  [[nodiscard]] CameraStance stance(double time) const { return {head_.truth(time), stage_.truth(time)}; }
  /// Returns the true view at `time` s; not for algorithms.
  [[nodiscard]] View view(double time) const { return description_.view(stance(time)); }
  /// Returns the head that ports() refers to, with its true state.
  [[nodiscard]] SimulatedHead& head() { return head_; }
  /// Returns the stage that ports() refers to, with its true state.
  [[nodiscard]] SimulatedStage& stage() { return stage_; }
  /// Returns the camera that ports() refers to, with frames for recording.
  [[nodiscard]] SimulatedCamera& camera() { return camera_; }
  /// Returns ports that this object owns: valid as long as it exists.
  [[nodiscard]] CameraPorts ports() { return {description_.config().name, &camera_, &head_, &stage_}; }

 private:
  Camera description_;
  SimulatedHead head_;
  SimulatedStage stage_;
  SimulatedCamera camera_;
};

/// A rig in simulated time: the true arm, drives and cameras. Tasks access it by ports and use their model of
/// it. The same configuration, pictures, seed and calls give bit-identical readings and frames. Queries do
/// not change the simulation.
class SimulatedRig {
 public:
  /// `truth` is the simulated world. Arm and drive of `model` convert commanded shapes into motor positions.
  /// The counters of heads and stages start at the model's initial camera positions. `make_plant` creates the
  /// true arm, which advances with the rig's clock. Throws std::invalid_argument with the text of
  /// truth_problem if truth and model do not match, or if an arm or camera is invalid.
  SimulatedRig(const RigConfig& model, const RigConfig& truth, const TakePicture& take_picture,
               std::uint64_t seed, const MakePlant& make_plant = true_plant);

  /// Returns ports that are valid as long as the rig.
  [[nodiscard]] RigPorts ports();

  /// Returns the clock of ports(); for the code that runs the simulation, not for algorithms.
  [[nodiscard]] SimulatedClock& clock() { return clock_; }
  /// Returns the arm of ports(), with its true state; not for algorithms.
  [[nodiscard]] SimulatedArm& arm() { return arm_; }
  /// Returns a camera; the index is that among the truth's cameras.
  [[nodiscard]] SimulatedView& camera(std::size_t index) { return *cameras_.at(index); }

 private:
  SimulatedClock clock_;
  SimulatedArm arm_;
  std::vector<std::unique_ptr<SimulatedView>> cameras_;
};

}  // namespace flexura
