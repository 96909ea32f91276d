#pragma once

#include <string>

#include "flexura/experiment/experiment.h"
#include "flexura/rig/photographer.h"
#include "flexura/sim/simulated_rig.h"

namespace flexura {

/// The simulated rig of a file without the rest of a run, for tasks at its ports.
class RigBench {
 public:
  explicit RigBench(const std::string& text)
      : experiment_(parse_experiment(text, "x.toml")),
        photographer_(experiment_),
        rig_(
            experiment_.model_rig(), experiment_.true_rig(),
            [this](const Shot& shot) { return photographer_.take(shot); }, 1) {}

  [[nodiscard]] const Experiment& experiment() const { return experiment_; }
  SimulatedRig& rig() { return rig_; }
  RigPorts ports() { return rig_.ports(); }

 private:
  Experiment experiment_;
  Photographer photographer_;
  SimulatedRig rig_;
};

}  // namespace flexura
