#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Rate of a bend (rad/s) or a stretch (1/s) from which any law counts as a jump: a turn in less than a
/// thousandth of a second.
inline constexpr double jump_rate = 1e4;

/// Smallest jump that counts: rad, or a factor of stretch.
inline constexpr double smallest_jump = 1e-6;

/// A law has two states at one time.
struct Jump {
  double time = 0;          ///< In s.
  double size = 0;          ///< Largest change of a bend (rad) or a stretch.
  std::size_t section = 0;  ///< Index of the section with that change.
  bool is_of_stretch = false;
};

/// Returns the largest change of a bend (rad) or a stretch (factor) of any section.
[[nodiscard]] double largest_change(const ArmState& a, const ArmState& b);

/// Returns the index of the section that changes most between two states.
[[nodiscard]] std::size_t most_changed(const ArmState& a, const ArmState& b);

/// Returns true if a section's stretch (factor) changes by more than its bend (rad).
[[nodiscard]] bool changes_stretch(const ArmState& a, const ArmState& b, std::size_t section);

/// Returns the jumps of any law. Searches every interval of `step` s by halving it towards its larger change:
/// a jump keeps its size, and a fast change does not. Finds a jump if it is at least 1/32 of the law's change
/// in its step. Ignores changes that are not finite. `until`: end of the search, s. `go_on` may be empty; it
/// receives the completed share, and returns false to end the search.
[[nodiscard]] std::vector<Jump> find_jumps(const Motion& motion, double step,
                                           double until = std::numeric_limits<double>::infinity(),
                                           const std::function<bool(double done)>& go_on = {});

}  // namespace flexura
