#pragma once

#include <functional>
#include <span>

#include "flexura/model/arm.h"
#include "flexura/model/drive.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// Adds to `report` where the command list of a motion asks more of a motor than it can do: speed, step rate,
/// acceleration, position. `times` (s, rising) are those of the list's rows, and `state_at` the arm's states.
///
/// From row to row a motor turns at an even rate, so these are exact, whatever the law: nothing lies between
/// two rows. The acceleration is the change of the rate over the time between the middles of two steps;
/// before the first row and after the last one the motors stand. Where it is too much, a caveat says that it
/// goes with the step. Taking up the play counts, rounding to microsteps does not. Ends before the first
/// state that is not possible.
void check_drive(const Arm& arm, const Drive& drive, const std::function<ArmState(double time)>& state_at,
                 std::span<const double> times, SafetyReport& report);

}  // namespace flexura
