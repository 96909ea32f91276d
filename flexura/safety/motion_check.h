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

/// A motion and its start, s.
struct TimedMotion {
  MotionPtr motion;
  double start = 0;
  std::string name = {};  ///< Name of its task, for messages.
};

/// Returns the hazards of motions played one after another from the state `initial`: bends, bend rates,
/// stretches, folding, contact with itself and with obstacles, jumps. For a law with known bounds on its
/// rates, nothing between two samples is missed (spans.h). Other laws are sampled every `step` s, and the
/// report states this. See docs/safety.md. `progress` may be null. It can end the check early; the report is
/// then incomplete.
[[nodiscard]] SafetyReport check_motions(const Arm& arm, const std::vector<Obstacle>& obstacles,
                                         const ArmState& initial, const std::vector<TimedMotion>& motions,
                                         double step, Progress* progress = nullptr);

/// Returns the hazards for an arm whose sections may be several arcs. The motions are commands (states of
/// model.driven()), whose bends, stretches and rates have limits. Folding and contact are those of the
/// resulting shape. A violation names the section.
[[nodiscard]] SafetyReport check_motions(const ArmModel& model, const std::vector<Obstacle>& obstacles,
                                         const ArmState& initial, const std::vector<TimedMotion>& motions,
                                         double step, Progress* progress = nullptr);

/// Returns true if the arm can have this state: bends up to `largest_bend`, finite lengths above 0.
[[nodiscard]] bool is_possible(const ArmState& state);

/// Returns the first section with an impossible state, from 0.
[[nodiscard]] std::optional<std::size_t> impossible_section(const ArmState& state);

}  // namespace flexura
