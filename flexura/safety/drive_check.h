#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/model/drive.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// Returns bounds on the rate of change of every section of a law in [start, end] s; std::nullopt if they are
/// unknown.
using RateBounds = std::function<std::optional<std::vector<SectionRates>>(double start, double end)>;

/// A time span in which the arm is servoed, s.
struct SteeredSpan {
  double start = 0, end = 0;
  bool is_planned = true;  ///< The commands in the span are known before the run.
};

/// Adds violations to `report` where the command list of a motion exceeds a motor's limits: speed, step rate,
/// acceleration, position. `times` (s, increasing) are those of the list's rows, and `state_at` gives the
/// arm's states. Ends before the first state that is not possible.
///
/// From row to row a motor turns at a constant rate. So for the list, in whole microsteps, speed, step rate
/// and position are exact for any law. If a single microstep in a short row exceeds the limit, the rate
/// before rounding counts, with a caveat. The law may be faster between two rows. For axes with a limit on
/// speed or step rate, without a violation in a row, `rates` may prove that it is not (tendon_speed_bounds).
/// A caveat names the axes without this proof.
///
/// The acceleration is the change of the rate, before rounding, over the time between the middles of two
/// steps. Before the first row and after the last one the motors rest, with a whole step to stop. If the
/// acceleration is too large, a caveat states that it depends on the step.
///
/// Backlash compensation counts. A caveat names the axes where it breaks a limit, and those where only the
/// rounding does.
///
/// In `steered` (increasing, disjoint), a CommandLimiter decides the commands during the run. It ignores
/// backlash and rounding in speeds and accelerations. So they are ignored there, with a caveat that names the
/// axes where either exceeds a limit. In a span that is not foreseen only positions count, because rates are
/// unknown.
void check_drive(const Arm& arm, const Drive& drive, const std::function<ArmState(double time)>& state_at,
                 std::span<const double> times, const RateBounds& rates, SafetyReport& report,
                 std::span<const SteeredSpan> steered = {});

}  // namespace flexura
