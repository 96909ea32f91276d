#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "flexura/model/backbone.h"
#include "flexura/rig/photographer.h"
#include "flexura/rig/rig.h"
#include "flexura/rig/truth_files.h"
#include "flexura/sim/crew.h"
#include "flexura/sim/simulated_rig.h"

namespace flexura {

/// The simulated rig of an experiment, whose cameras film it. The same frames, whatever number of threads
/// draws them.
class Filming : public Rig, private RigTruth {
 public:
  /// One thread a camera.
  explicit Filming(const Setup& setup);
  Filming(const Setup& setup, std::size_t threads);

  /// The clock is at the last call's time.
  [[nodiscard]] RigPorts ports() override { return rig_.ports(); }
  [[nodiscard]] RigTruth* truth() override { return this; }
  [[nodiscard]] bool is_simulated() const override { return true; }
  /// Frames that cameras deliver during one call are drawn at the same time.
  void play_to(double time, const ArmState& state, const TakeFrame& take) override;
  void pass_to(double time, const ArmState& state) override;
  void skip_to_now() override;

  /// What the camera in this place would expose from `start` s on, up to which the motion must have been
  /// played; at the start of a frame, that frame.
  [[nodiscard]] Shot shot(std::size_t camera, double start);
  [[nodiscard]] Picture take(const Shot& shot) { return photographers_[shot.camera]->take(shot); }
  /// What stands before the camera of `shot` at a time since its start.
  [[nodiscard]] ShownScene shown(const Shot& shot, double time) const {
    return {photographers_[shot.camera]->scene(shot.backbone(time)), shot.view(time)};
  }

 private:
  [[nodiscard]] RigStance stance(std::size_t camera) override;
  [[nodiscard]] Backbone backbone(double time) override { return rig_.arm().backbone(time); }
  [[nodiscard]] std::vector<double> tensions(double time) override {
    return rig_.arm().plant().tensions(time);
  }
  [[nodiscard]] std::vector<double> pulled(double time) override { return rig_.arm().plant().pulled(time); }
  [[nodiscard]] std::optional<RodEnergy> energy(double time) override {
    return rig_.arm().plant().energy(time);
  }
  [[nodiscard]] std::string warning(double time) override { return rig_.arm().plant().warning(time); }
  [[nodiscard]] std::vector<PlantContact> contacts(double time) override {
    return rig_.arm().plant().contacts(time);
  }
  [[nodiscard]] std::vector<double> lost_steps(double time) override {
    return rig_.arm().plant().lost_steps(time);
  }
  [[nodiscard]] std::vector<FilmedFrame> new_frames();

  std::vector<CameraConfig> cameras_;
  std::vector<std::unique_ptr<Photographer>> photographers_;  // each camera's own: they draw at the same time
  SimulatedRig rig_;
  std::uint64_t seed_;
  double stretch_;  // of time that is filmed at once, s: a few frames of the fastest camera
  Crew crew_;
};

}  // namespace flexura
