#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "flexura/experiment/experiment.h"
#include "flexura/experiment/photographer.h"
#include "flexura/port/camera_port.h"
#include "flexura/sim/simulated_rig.h"

namespace flexura {

/// Plays an experiment's motion on its simulated rig and hands out the frames that its cameras deliver on the
/// way.
class Filming {
 public:
  explicit Filming(const Experiment& experiment);

  using TakeFrame = std::function<void(const std::string& camera, const Frame& frame)>;

  /// Commands the arm to be in `state` at `time` s, not before the call's before, and gives every frame
  /// received until then, in the order of time and then of the cameras.
  void play_to(double time, const ArmState& state, const TakeFrame& take);

 private:
  struct Next {
    std::size_t camera;
    std::int64_t frame;
    double received;
  };
  [[nodiscard]] Next next() const;

  Photographer photographer_;
  SimulatedRig rig_;
  std::vector<CameraConfig> cameras_;
  std::vector<std::int64_t> frames_;  // that each camera has delivered or lost
};

}  // namespace flexura
