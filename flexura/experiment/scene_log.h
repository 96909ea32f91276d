#pragma once

#include <optional>

#include "flexura/experiment/experiment.h"
#include "flexura/log/scene_messages.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Returns the objects around the arm at the start of a run: screens, etalon, obstacles.
[[nodiscard]] SceneMessage stand_message(const Experiment& experiment);

/// Returns the poses of the arm's base ("base") and the cameras' optical frames ("camera/NAME") at the start.
[[nodiscard]] FramesMessage frames_message(const Experiment& experiment);

/// Returns the arm along `backbone`: strips with the mean thickness of its sections, in micrometres.
[[nodiscard]] SceneMessage arm_message(const ColorConfig& color, double time, const Backbone& backbone);

/// Selects the states with a drawing of the arm: the first, and then ten per second of simulated time.
class SceneTimes {
 public:
  /// Returns true if a state at `time` s, after those of all previous calls, is selected.
  [[nodiscard]] bool is_next(double time);

 private:
  std::optional<double> last_;
};

}  // namespace flexura
