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

/// Bounds on how fast every section of a law changes anywhere in [start, end] s; empty where none are known.
using RateBounds = std::function<std::optional<std::vector<SectionRates>>(double start, double end)>;

/// A time in which the arm is steered, s.
struct SteeredSpan {
  double start = 0, end = 0;
  bool is_foreseen = true;  ///< What is sent then is known.
};

/// Adds to `report` where the command list of a motion asks more of a motor than it can do: speed, step rate,
/// acceleration, position. `times` (s, rising) are those of the list's rows, and `state_at` the arm's states.
///
/// From row to row a motor turns at an even rate, so for the list, as it is written in whole microsteps,
/// speed, step rate and position are exact, whatever the law. (A single microstep in a row so short that this
/// alone is beyond the limit is judged by the motion that it is rounded from, and told in a caveat.) The law
/// itself may be faster between two rows: of the axes with a limit on speed or step rate that no row breaks,
/// a caveat names those for which `rates` do not prove (tendon_speed_bounds) that it never is. The
/// acceleration is the change of the rate, before rounding, over the time between the middles of two steps;
/// before the first row and after the last one the motors stand, and there is a whole step to stop in. Where
/// it is too much, a caveat says that it goes with the step. Taking up the play counts, and a caveat names
/// the axes where that is what breaks a limit, and those where nothing but the rounding does. Ends before the
/// first state that is not possible.
///
/// In `steered` (rising, apart) a CommandLimiter decides on the way what is sent, which counts neither play
/// nor rounding of speeds and accelerations: there they are left out, and a caveat names the axes where
/// either asks for more than a limit. Of a span that is not foreseen positions alone count: nobody knows how
/// fast it goes.
void check_drive(const Arm& arm, const Drive& drive, const std::function<ArmState(double time)>& state_at,
                 std::span<const double> times, const RateBounds& rates, SafetyReport& report,
                 std::span<const SteeredSpan> steered = {});

}  // namespace flexura
