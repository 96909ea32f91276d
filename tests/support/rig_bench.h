#pragma once

#include <functional>
#include <string>

#include "flexura/experiment/experiment.h"
#include "flexura/rig/photographer.h"
#include "flexura/sim/simulated_rig.h"

namespace flexura {

/// The simulated rig of a file without the rest of a run, for tasks at its ports.
class RigBench {
 public:
  /// `change`: changes the true rig.
  explicit RigBench(
      const std::string& text, const std::function<void(RigConfig&)>& change = [](RigConfig&) {})
      : experiment_(parse_experiment(text, "x.toml")),
        photographer_(experiment_),
        rig_(
            experiment_.model_rig(), changed(experiment_.true_rig(), change),
            [this](const Shot& shot) { return photographer_.take(shot); }, 1) {}

  [[nodiscard]] const Experiment& experiment() const { return experiment_; }
  SimulatedRig& rig() { return rig_; }
  RigPorts ports() { return rig_.ports(); }

 private:
  static RigConfig changed(RigConfig rig, const std::function<void(RigConfig&)>& change) {
    change(rig);
    return rig;
  }

  Experiment experiment_;
  Photographer photographer_;
  SimulatedRig rig_;
};

}  // namespace flexura
