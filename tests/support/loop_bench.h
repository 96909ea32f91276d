#pragma once

#include <gtest/gtest.h>

#include <string>

#include "flexura/calibrate/rig_aim.h"
#include "flexura/experiment/calibrate_config.h"
#include "flexura/experiment/experiment.h"
#include "flexura/experiment/photographer.h"
#include "flexura/sim/simulated_rig.h"

namespace flexura {

class NobodyWatches : public RigSessionWatcher {
 public:
  void arm_sent(double, const ArmState&, double) override {}
  void camera_sent(double, const RigStance&) override {}
  void seen(const RigSight&) override {}
  void known(const RigStep&) override {}
};

/// One of the paper's methods at the ports alone, with nothing of a run around it: the file's first task.
class LoopBench {
 public:
  explicit LoopBench(const std::string& text)
      : experiment_(parse_experiment(text, "x.toml")),
        photographer_(experiment_),
        rig_(
            experiment_.model_rig(), experiment_.true_rig(),
            [this](const Shot& shot) { return photographer_.take(shot); }, 1) {}

  SimulatedRig& rig() { return rig_; }
  RigPorts ports() { return rig_.ports(); }
  LoopResult calibrate() { return calibrate(ports()); }
  LoopResult calibrate(const RigPorts& ports) {
    NobodyWatches nobody;
    return calibrate(ports, nobody);
  }
  LoopResult calibrate(const RigPorts& ports, RigSessionWatcher& watcher) {
    const auto& task = std::get<CalibrateTask>(experiment_.task.front());
    const RigModel believed = rig_model(experiment_.arm.arm(), experiment_.cameras());
    const LoopConfig config = loop_config(task, experiment_.arm, experiment_.cameras(), experiment_.stand);
    return calibrate_by_loop(ports, believed, config, watcher);
  }
  /// What truly remains where the cameras stand.
  RigRemainder truth(const LoopResult& result) {
    const RigConfig truth = experiment_.true_rig();
    const double now = rig_.clock().now();
    std::array<RigStance, 2> stances;
    for (std::size_t i = 0; i < 2; ++i)
      stances[i] = {i, rig_.camera(i).head().truth(now), rig_.camera(i).stage().truth(now)};
    return remainder(rig_model(truth.arm.arm(), truth.cameras), stances, result.target);
  }
  /// Whether heads and stages are where the file starts them.
  void expect_back() {
    for (std::size_t i = 0; i < rig_.camera_count(); ++i) {
      const auto head = rig_.camera(i).head().read().value().state;
      EXPECT_NEAR(head.pan, 0, 1e-9);
      EXPECT_NEAR(head.tilt, 0, 1e-9);
      EXPECT_NEAR(rig_.camera(i).stage().read().value().state.offset.norm(), 0, 1e-9);
    }
  }

 private:
  Experiment experiment_;
  Photographer photographer_;
  SimulatedRig rig_;
};

/// A head whose pan motor takes commands and does not turn.
class StuckPan : public HeadPort {
 public:
  explicit StuckPan(HeadPort& head) : head_(head) {}
  CommandOutcome command(const HeadState& state) override {
    HeadState reached = state;
    reached.pan = 0;
    return head_.command(reached);
  }
  CommandOutcome halt() override { return head_.halt(); }
  Outcome<HeadReading> read() override { return head_.read(); }

 private:
  HeadPort& head_;
};

}  // namespace flexura
