#pragma once

#include <vector>

#include "flexura/sim/rod_inputs.h"

namespace flexura {

/// `rotor_time`: approximate duration of an overload after which a rotor yields, s. `fall_time`: time in
/// which a rotor falls back by a turn of its magnetic field, s. Both times are half a period of a rotor that
/// oscillates in its field at about 100 Hz.
inline constexpr double rotor_time = 5e-3, fall_time = 5e-3;

/// State of the rotors of a drive's motors relative to their magnetic fields. The tension that acts on a
/// rotor follows the actual tension with the time constant rotor_time. If the load exceeds the pull-out
/// torque, the rotor falls back by one turn of the field, at a constant rate during fall_time. If the load is
/// still too large, the rotor falls back by another turn. Hence lost steps do not depend on the time step, if
/// the time step is shorter than both times.
struct RotorState {
  std::vector<double> felt;    ///< Delayed tensions that act on the rotors, N.
  std::vector<double> behind;  ///< Current lag of each rotor behind its controller, microsteps.
  /// Lag that each rotor will have when its fall-back ends: whole turns of the field, in microsteps.
  std::vector<double> lost;
};

/// Returns the state of motors at rest under these tensions, N; empty without a drive.
[[nodiscard]] RotorState rotors_at_rest(const RodInputs& inputs, const std::vector<double>& tensions);

/// Advances the rotors by `h` s to `time`. `tensions`: tensions at `time`, N.
void turn_rotors(RotorState& rotors, const RodInputs& inputs, const std::vector<double>& tensions,
                 double time, double h);

/// Returns whether any rotor falls back now, or may soon do so under these tensions, N.
[[nodiscard]] bool are_strained(const RotorState& rotors, const RodInputs& inputs,
                                const std::vector<double>& tensions, double time);

}  // namespace flexura
