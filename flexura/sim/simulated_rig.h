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

/// A camera of the simulated world with what moves it.
class SimulatedView {
 public:
  /// The camera as it is `nominal` to be, whose start its head and stage count, and as it truly is. `shot`
  /// and `take_picture` as SimulatedCamera takes them; the shot's view is filled in.
  SimulatedView(const CameraConfig& nominal, const CameraConfig& config, Shot shot,
                const TakePicture& take_picture, SimulatedClock& clock, double horizon);

  /// The camera as it truly is.
  [[nodiscard]] const Camera& description() const { return description_; }
  /// How it truly stands at `time` s: not for algorithms.
  [[nodiscard]] CameraStance stance(double time) const { return {head_.truth(time), stage_.truth(time)}; }
  /// What it truly sees then: not for algorithms.
  [[nodiscard]] View view(double time) const { return description_.view(stance(time)); }
  [[nodiscard]] SimulatedHead& head() { return head_; }        ///< Behind ports(), with its truth.
  [[nodiscard]] SimulatedStage& stage() { return stage_; }     ///< Likewise.
  [[nodiscard]] SimulatedCamera& camera() { return camera_; }  ///< Likewise.
  /// They stay its own: valid as long as this.
  [[nodiscard]] CameraPorts ports() { return {description_.config().name, &camera_, &head_, &stage_}; }

 private:
  Camera description_;
  SimulatedHead head_;
  SimulatedStage stage_;
  SimulatedCamera camera_;
};

/// A rig in simulated time: an arm, its drives and cameras as they truly are, behind ports that tasks use
/// with what they believe. The same configuration, pictures, seed and calls give the same readings and
/// frames, bit for bit, and asking does not change what happens.
class SimulatedRig {
 public:
  /// `truth` is the simulated world; of `model` arm and drive are used, to turn commanded shapes into
  /// motor positions, and where the cameras stand at the start, which their heads and stages count.
  /// `make_plant` makes the arm as it truly is, which goes on with the rig's clock.
  /// std::invalid_argument: truth_problem's text, or what is no arm or camera.
  SimulatedRig(const RigConfig& model, const RigConfig& truth, const TakePicture& take_picture,
               std::uint64_t seed, const MakePlant& make_plant = true_plant);

  /// Valid as long as the rig.
  [[nodiscard]] RigPorts ports();

  /// What stands behind ports(), with its truth: for who plays the rig, not for algorithms.
  [[nodiscard]] SimulatedClock& clock() { return clock_; }
  [[nodiscard]] SimulatedArm& arm() { return arm_; }  ///< Likewise.
  /// In the order of the truth's cameras.
  [[nodiscard]] SimulatedView& camera(std::size_t index) { return *cameras_.at(index); }

 private:
  SimulatedClock clock_;
  SimulatedArm arm_;
  std::vector<std::unique_ptr<SimulatedView>> cameras_;
};

}  // namespace flexura
