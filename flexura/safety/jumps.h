#pragma once

#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"

namespace flexura {

/// The smallest jump that counts: rad, or a factor of stretch.
inline constexpr double smallest_jump = 1e-6;

/// A law asks for two states at one time.
struct Jump {
  double time = 0;  ///< s
  double size = 0;  ///< Of the largest change of a bend (rad) or a stretch.
};

/// The largest change of a bend (rad) or a stretch (factor) of any section.
[[nodiscard]] double largest_change(const ArmState& a, const ArmState& b);

/// The jumps of a law that changes somehow, looked for in every interval of `step` s: the interval is halved
/// towards its larger change; a jump keeps its size, what is only fast does not. A jump is found when it is
/// at least 1/32 of what the law changes in its step. Changes that are not finite are none.
[[nodiscard]] std::vector<Jump> find_jumps(const Motion& motion, double step);

}  // namespace flexura
