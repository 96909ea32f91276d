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

/// Returns the arm along `backbone` as polylines. Each has the mean thickness of its section, rounded to
/// micrometres.
[[nodiscard]] SceneMessage arm_message(const ColorConfig& color, double time, const Backbone& backbone);

/// Selects the states at which the arm is drawn: the first, and then ten per second of simulated time.
class SceneTimes {
 public:
  /// Returns true if the state at `time` (s) is selected. The times of successive calls must increase.
  [[nodiscard]] bool is_next(double time);

 private:
  std::optional<double> last_;
};

}  // namespace flexura
