#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "flexura/model/backbone.h"
#include "flexura/rig/photographer.h"
#include "flexura/rig/rig.h"
#include "flexura/rig/truth_files.h"
#include "flexura/sim/simulated_rig.h"
#include "flexura/sim/thread_pool.h"

namespace flexura {

/// Simulated rig of an experiment, with frames rendered for its cameras. The frames do not depend on the
/// number of threads.
class Filming : public Rig, private RigTruth {
 public:
  /// Uses one thread per camera.
  explicit Filming(const Setup& setup);
  Filming(const Setup& setup, std::size_t threads);

  /// Returns the ports. The clock of the ports shows the time up to which the rig has been advanced.
  [[nodiscard]] RigPorts ports() override { return rig_->ports(); }
  [[nodiscard]] RigTruth* truth() override { return this; }
  [[nodiscard]] bool is_simulated() const override { return true; }
  /// Advances the rig as described in Rig. The frames of one call are rendered in parallel.
  void play_to(double time, const ArmState& state, const TakeFrame& take) override;
  void pass_to(double time, const ArmState& state) override;
  void skip_to_now() override;

  /// Returns the exposure of a camera that begins at `start`, s. The rig must have been advanced to this
  /// time. If a frame begins at `start`, the result is the exposure of this frame.
  [[nodiscard]] Shot shot(std::size_t camera, double start);
  [[nodiscard]] Picture take(const Shot& shot) { return photographers_[shot.camera]->take(shot); }
  /// Returns the simulated rig.
  [[nodiscard]] SimulatedRig& simulation() { return *rig_; }
  /// Returns the simulated rig in its present state, and gives up its ownership. The rig remains usable
  /// without this object, except for frames. Afterwards this object can only be destroyed.
  [[nodiscard]] std::unique_ptr<SimulatedRig> give_away() { return std::move(rig_); }
  /// Returns the scene and the view of the camera of `shot`. `time`: s since the start of the exposure.
  [[nodiscard]] ShownScene shown(const Shot& shot, double time) const {
    return {photographers_[shot.camera]->scene(shot.backbone(time)), shot.view(time)};
  }

 private:
  [[nodiscard]] RigStance stance(std::size_t camera) override;
  [[nodiscard]] Backbone backbone(double time) override { return rig_->arm().backbone(time); }
  [[nodiscard]] std::vector<double> tensions(double time) override {
    return rig_->arm().plant().tensions(time);
  }
  [[nodiscard]] std::vector<double> pulled(double time) override { return rig_->arm().plant().pulled(time); }
  [[nodiscard]] std::optional<RodEnergy> energy(double time) override {
    return rig_->arm().plant().energy(time);
  }
  [[nodiscard]] std::string warning(double time) override { return rig_->arm().plant().warning(time); }
  [[nodiscard]] std::vector<PlantContact> contacts(double time) override {
    return rig_->arm().plant().contacts(time);
  }
  [[nodiscard]] std::vector<double> lost_steps(double time) override {
    return rig_->arm().plant().lost_steps(time);
  }
  [[nodiscard]] std::vector<FilmedFrame> new_frames();

  std::vector<CameraConfig> cameras_;
  std::vector<std::unique_ptr<Photographer>> photographers_;  // One per camera, to render in parallel.
  std::unique_ptr<SimulatedRig> rig_;                         // Null after give_away().
  std::uint64_t seed_;
  double stretch_;  // Duration that is rendered at once, s: a few frames of the fastest camera.
  ThreadPool thread_pool_;
};

}  // namespace flexura
