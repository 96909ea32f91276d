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

/// Function that returns bounds on the rates of every section of a motion during [start, end], s;
/// std::nullopt if unknown.
using RateBounds = std::function<std::optional<std::vector<SectionRates>>(double start, double end)>;

/// A time span, s, in which feedback control moves the arm.
struct SteeredSpan {
  double start = 0, end = 0;
  bool is_planned = true;  ///< Whether the commands in the span are known before the run.
};

/// Checks the list of motor commands of a motion against the motors' limits on speed, step rate, acceleration
/// and position, and adds violations to `report`. `times`: increasing times of the list's rows, s. `state_at`
/// returns the arm's state at a time. The check ends before the first impossible state.
///
/// A motor turns at a constant rate between two rows. Hence speed, step rate and position of the list, in
/// whole microsteps, are exact for any motion. If a single microstep in a short row exceeds the limit, the
/// rate before rounding is checked instead, with a caveat. Between two rows, the motion itself may be faster
/// than the list. The bounds from `rates` may prove that the motion is not faster than the list
/// (tendon_speed_bounds). A caveat names the axes without this proof that have a limit on speed or step rate
/// and no violation in a row.
///
/// The acceleration is the change of the rate, before rounding, divided by the time between the middles of
/// two rows. The motors are at rest before the first row and after the last row, so they must start and stop
/// within one step. If the acceleration is too large, a caveat states that it depends on the step.
///
/// The checked values include backlash compensation. Caveats name the axes where only the backlash
/// compensation, or only the rounding, violates a limit.
///
/// In the spans `steered` (increasing, disjoint), a CommandLimiter determines the commands during the run.
/// The limiter ignores backlash and rounding in speeds and accelerations. Hence the check ignores backlash
/// and rounding in these spans. A caveat names the axes for which backlash or rounding exceeds a limit. In
/// spans that are not planned, only positions are checked, because rates are unknown.
void check_drive(const Arm& arm, const Drive& drive, const std::function<ArmState(double time)>& state_at,
                 std::span<const double> times, const RateBounds& rates, SafetyReport& report,
                 std::span<const SteeredSpan> steered = {});

}  // namespace flexura
