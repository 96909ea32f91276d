#pragma once

#include <optional>

#include "flexura/experiment/experiment.h"
#include "flexura/log/scene_messages.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// What stands around the arm at the start of a run: screens, etalon, obstacles.
[[nodiscard]] SceneMessage stand_message(const Experiment& experiment);

/// Where the arm's base ("base") and the cameras' optical frames ("camera/NAME") stand at the start.
[[nodiscard]] FramesMessage frames_message(const Experiment& experiment);

/// The arm along `backbone`: strips as thick as its sections are on average, in micrometres.
[[nodiscard]] SceneMessage arm_message(const ColorConfig& color, double time, const Backbone& backbone);

/// Which states have the arm drawn: the first, and then ten a second of simulated time.
class SceneTimes {
 public:
  /// Whether a state at `time` s, after all that were asked for before, is one.
  [[nodiscard]] bool is_next(double time);

 private:
  std::optional<double> last_;
};

}  // namespace flexura
