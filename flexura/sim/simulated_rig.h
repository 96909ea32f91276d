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
  /// model `nominal`. `shot` and `take_picture` are as for SimulatedCamera; the constructor sets the shot's
  /// `view`.
  SimulatedView(const CameraConfig& nominal, const CameraConfig& config, Shot shot,
                const TakePicture& take_picture, SimulatedClock& clock, double horizon);

  /// Returns the true camera.
  [[nodiscard]] const Camera& description() const { return description_; }
  /// Returns the true axis positions at `time` s; not for algorithms.
  [[nodiscard]] CameraStance stance(double time) const { return {head_.truth(time), stage_.truth(time)}; }
  /// Returns the true view at `time` s; not for algorithms.
  [[nodiscard]] View view(double time) const { return description_.view(stance(time)); }
  /// Returns the simulated head of ports(), with access to its true state.
  [[nodiscard]] SimulatedHead& head() { return head_; }
  /// Returns the simulated stage of ports(), with access to its true state.
  [[nodiscard]] SimulatedStage& stage() { return stage_; }
  /// Returns the simulated camera of ports(), with access to frames for recording.
  [[nodiscard]] SimulatedCamera& camera() { return camera_; }
  /// Returns ports to devices that this object owns. The ports are valid as long as this object exists.
  [[nodiscard]] CameraPorts ports() { return {description_.config().name, &camera_, &head_, &stage_}; }

 private:
  Camera description_;
  SimulatedHead head_;
  SimulatedStage stage_;
  SimulatedCamera camera_;
};

/// A rig in simulated time: the true arm, drives and cameras. Tasks access the rig by ports and use a model
/// of the rig. Equal configurations, pictures, seeds and calls give bit-identical readings and frames.
/// Queries do not change the simulation.
class SimulatedRig {
 public:
  /// `truth` is the simulated world. Arm and drive of `model` convert commanded shapes into motor positions.
  /// The counters of heads and stages start at the model's initial camera positions. `make_plant` creates the
  /// true arm, which advances with the rig's clock. Throws std::invalid_argument with the text of
  /// truth_problem() if truth and model do not match. Also throws std::invalid_argument if an arm or a camera
  /// is invalid.
  SimulatedRig(const RigConfig& model, const RigConfig& truth, const TakePicture& take_picture,
               std::uint64_t seed, const MakePlant& make_plant = true_plant);

  /// Returns ports that are valid as long as the rig exists.
  [[nodiscard]] RigPorts ports();

  /// Returns the clock of ports(); for the code that runs the simulation, not for algorithms.
  [[nodiscard]] SimulatedClock& clock() { return clock_; }
  /// Returns the simulated arm of ports(), with access to its true state; not for algorithms.
  [[nodiscard]] SimulatedArm& arm() { return arm_; }
  /// Returns a simulated camera. `index`: index among the truth's cameras.
  [[nodiscard]] SimulatedView& camera(std::size_t index) { return *cameras_.at(index); }

 private:
  SimulatedClock clock_;
  SimulatedArm arm_;
  std::vector<std::unique_ptr<SimulatedView>> cameras_;
};

}  // namespace flexura
