#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/obstacle.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// A motion with its start time.
struct TimedMotion {
  MotionPtr motion;
  double start = 0;       ///< Start time, s.
  std::string name = {};  ///< Name of the motion's task, for messages.
};

/// Checks motions that are executed one after another from the state `initial` (docs/safety.md). Hazards are
/// bends, bend rates, stretches, stretch rates, folding, self-contact, contact with obstacles, and jumps. For
/// a motion with known bounds on its rates, the check misses nothing between samples (spans.h). Other motions
/// are sampled every `step` s, and the report states this. `progress` may be null. If the check is cancelled,
/// the report is incomplete.
[[nodiscard]] SafetyReport check_motions(const Arm& arm, const std::vector<Obstacle>& obstacles,
                                         const ArmState& initial, const std::vector<TimedMotion>& motions,
                                         double step, Progress* progress = nullptr);

/// Checks motions of an arm whose sections may be several arcs. The motions are commands (states of
/// model.driven()), whose bends, stretches and rates are checked. Folding and contact are checked for the
/// resulting shape. Violations refer to sections, not to arcs.
[[nodiscard]] SafetyReport check_motions(const ArmModel& model, const std::vector<Obstacle>& obstacles,
                                         const ArmState& initial, const std::vector<TimedMotion>& motions,
                                         double step, Progress* progress = nullptr);

/// Returns true for hazards of the arm's shape, and false for hazards of the command.
[[nodiscard]] bool is_of_shape(Hazard hazard);

/// Returns whether a state is possible: bends are at most `largest_bend`, and lengths are finite and above 0.
[[nodiscard]] bool is_possible(const ArmState& state);

/// Returns the index of the first section with an impossible state, if any.
[[nodiscard]] std::optional<std::size_t> impossible_section(const ArmState& state);

}  // namespace flexura
