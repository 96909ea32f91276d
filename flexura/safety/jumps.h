#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Rate of a bend (rad/s) or a stretch (1/s) above which a change counts as a jump. For a bend, this rate is
/// more than a full turn in 1 ms.
inline constexpr double jump_rate = 1e4;

/// Smallest jump that is reported: rad for a bend, a factor for a stretch.
inline constexpr double smallest_jump = 1e-6;

/// A jump of a motion: the motion has two states at one time.
struct Jump {
  double time = 0;          ///< Time of the jump, s.
  double size = 0;          ///< Largest change of a bend (rad) or a stretch.
  std::size_t section = 0;  ///< Index of the section with the largest change.
  /// Whether the largest change is of the section's stretch instead of its bend.
  bool is_of_stretch = false;
};

/// Returns the largest change of a bend (rad) or a stretch (factor) of any section between two states.
[[nodiscard]] double largest_change(const ArmState& a, const ArmState& b);

/// Returns the index of the section that changes most between two states.
[[nodiscard]] std::size_t most_changed(const ArmState& a, const ArmState& b);

/// Returns whether a section's stretch (factor) changes more between two states than its bend (rad).
[[nodiscard]] bool changes_stretch(const ArmState& a, const ArmState& b, std::size_t section);

/// Returns the jumps of any motion up to the time `until`, s. Repeatedly halves every interval of `step` s
/// and continues in the half with the larger change. When an interval is halved, the change at a jump keeps
/// its size, but the change of a fast motion decreases. A jump is found if it is at least 1/32 of the
/// motion's change within the step. Changes that are not finite are ignored. `go_on` may be empty. `go_on`
/// receives the completed share of the search, and returns false to end the search.
[[nodiscard]] std::vector<Jump> find_jumps(const Motion& motion, double step,
                                           double until = std::numeric_limits<double>::infinity(),
                                           const std::function<bool(double done)>& go_on = {});

}  // namespace flexura
