#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"

namespace flexura {

/// A bend (rad/s) or a stretch (1/s) that changes faster jumps, whatever its law: a turn in less than a
/// thousandth of a second.
inline constexpr double jump_rate = 1e4;

/// The smallest jump that counts: rad, or a factor of stretch.
inline constexpr double smallest_jump = 1e-6;

/// A law asks for two states at one time.
struct Jump {
  double time = 0;          ///< s
  double size = 0;          ///< Of the largest change of a bend (rad) or a stretch.
  std::size_t section = 0;  ///< From 0: whose change that is.
  bool is_of_stretch = false;
};

/// The largest change of a bend (rad) or a stretch (factor) of any section.
[[nodiscard]] double largest_change(const ArmState& a, const ArmState& b);

/// The section that changes most between two states, from 0.
[[nodiscard]] std::size_t most_changed(const ArmState& a, const ArmState& b);

/// Whether a section's stretch (factor) changes by more than its bend (rad).
[[nodiscard]] bool changes_stretch(const ArmState& a, const ArmState& b, std::size_t section);

/// The jumps of a law that changes somehow, looked for in every interval of `step` s: the interval is halved
/// towards its larger change; a jump keeps its size, what is only fast does not. A jump is found when it is
/// at least 1/32 of what the law changes in its step. Changes that are not finite are none. `until`: the time
/// up to which it is looked for, s.
[[nodiscard]] std::vector<Jump> find_jumps(const Motion& motion, double step,
                                           double until = std::numeric_limits<double>::infinity());

}  // namespace flexura
