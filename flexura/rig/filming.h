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

/// Simulated rig of an experiment, filmed by its cameras. The frames do not depend on the number of threads.
class Filming : public Rig, private RigTruth {
 public:
  /// Uses one thread per camera.
  explicit Filming(const Setup& setup);
  Filming(const Setup& setup, std::size_t threads);

  /// The clock is at the last call's time.
  [[nodiscard]] RigPorts ports() override { return rig_->ports(); }
  [[nodiscard]] RigTruth* truth() override { return this; }
  [[nodiscard]] bool is_simulated() const override { return true; }
  /// Renders the frames of one call in parallel.
  void play_to(double time, const ArmState& state, const TakeFrame& take) override;
  void pass_to(double time, const ArmState& state) override;
  void skip_to_now() override;

  /// Returns the exposure of a camera from `start` s on, up to which the motion must have been played. At the
  /// start of a frame it is that frame.
  [[nodiscard]] Shot shot(std::size_t camera, double start);
  [[nodiscard]] Picture take(const Shot& shot) { return photographers_[shot.camera]->take(shot); }
  /// Returns the simulated rig as it stands when nobody plays it any more: it goes on without this, but its
  /// cameras must not be asked for frames. Afterwards this can only be destroyed.
  [[nodiscard]] std::unique_ptr<SimulatedRig> give_away() { return std::move(rig_); }
  /// Returns the scene before the camera of `shot` at a time since its start.
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
  std::unique_ptr<SimulatedRig> rig_;                         // Null once given away.
  std::uint64_t seed_;
  double stretch_;  // Time filmed at once, s: a few frames of the fastest camera.
  ThreadPool thread_pool_;
};

}  // namespace flexura
