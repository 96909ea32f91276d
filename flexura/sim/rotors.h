#pragma once

#include <vector>

#include "flexura/sim/rod_inputs.h"

namespace flexura {

/// Approximate time that a load must last until a rotor yields to it, and time to fall back by a turn of its
/// field, s. Both are half a period of a rotor that swings in its field at about 100 Hz.
inline constexpr double rotor_time = 5e-3, fall_time = 5e-3;

/// State of the rotors of a drive's motors relative to their fields. The tension felt by a rotor follows the
/// actual tension within rotor_time. If the load exceeds its pull-out torque, the rotor falls back by a turn
/// of its field, at constant rate within fall_time. If the load is still too large, it falls back by another
/// turn. So lost steps do not depend on the time steps, provided these are shorter.
struct RotorState {
  std::vector<double> felt;    ///< Tensions at the axes as the rotors feel them, N.
  std::vector<double> behind;  ///< Current lag of each rotor, microsteps.
  std::vector<double> lost;    ///< Lag after the fall-back is complete, microsteps: whole turns of the field.
};

/// Returns the state of motors at rest under these tensions, N; empty without a drive.
[[nodiscard]] RotorState rotors_at_rest(const RodInputs& inputs, const std::vector<double>& tensions);

/// Advances by `h` s up to `time`, with the tensions at that time, N.
void turn_rotors(RotorState& rotors, const RodInputs& inputs, const std::vector<double>& tensions,
                 double time, double h);

/// Returns whether any rotor falls back, or may soon under these tensions, N.
[[nodiscard]] bool are_strained(const RotorState& rotors, const RodInputs& inputs,
                                const std::vector<double>& tensions, double time);

}  // namespace flexura
