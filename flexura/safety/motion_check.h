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

/// A motion and when it starts, s.
struct TimedMotion {
  MotionPtr motion;
  double start = 0;
  std::string name = {};  ///< Of its task, for messages.
};

/// What would harm the arm in motions played one after another from the state `initial`: bends, bend rates,
/// stretches, folding, contact with itself and with obstacles, jumps. Where a law knows bounds on its rates,
/// nothing slips between two samples (spans.h); elsewhere it is sampled every `step` s, and the report says
/// so. See docs/safety.md. `progress` may be null; when it says so, the check ends early, and its report is
/// not complete.
[[nodiscard]] SafetyReport check_motions(const Arm& arm, const std::vector<Obstacle>& obstacles,
                                         const ArmState& initial, const std::vector<TimedMotion>& motions,
                                         double step, Progress* progress = nullptr);

/// The same of an arm whose sections may be several arcs: the motions are commands (states of
/// model.driven()), whose bends, stretches and rates have limits; folding and contact are those of the shape
/// that they make. A violation names the section.
[[nodiscard]] SafetyReport check_motions(const ArmModel& model, const std::vector<Obstacle>& obstacles,
                                         const ArmState& initial, const std::vector<TimedMotion>& motions,
                                         double step, Progress* progress = nullptr);

/// Whether the arm can stand in this state at all: bends up to `largest_bend`, finite lengths above 0.
[[nodiscard]] bool is_possible(const ArmState& state);

/// The first section that cannot, from 0.
[[nodiscard]] std::optional<std::size_t> impossible_section(const ArmState& state);

}  // namespace flexura
