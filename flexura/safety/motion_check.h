#pragma once

#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// A motion and when it starts, s.
struct TimedMotion {
  MotionPtr motion;
  double start = 0;
};

/// What the arm's own limits say of motions played one after another from the state `initial`: bends, bend
/// rates, stretches, folding, jumps. Where a law knows bounds on its rates, nothing slips between two samples
/// (spans.h); elsewhere it is sampled every `step` s, and the report says so.
[[nodiscard]] SafetyReport check_motions(const Arm& arm, const ArmState& initial,
                                         const std::vector<TimedMotion>& motions, double step);

}  // namespace flexura
