#pragma once

#include <vector>

#include "flexura/sim/rod_inputs.h"

namespace flexura {

/// How long a load must last until a rotor yields to it, about, and how long it takes to fall back by a turn
/// of its field, s: half a period of a rotor that swings in its field at some 100 Hz.
inline constexpr double rotor_time = 5e-3, fall_time = 5e-3;

/// How the rotors of a drive's motors stand against their fields. What a rotor feels follows the tension
/// within rotor_time. Where that is more than its pull-out torque it falls back by a turn of its field,
/// evenly within fall_time; if it is too much still, by another one. So what is lost does not depend on how
/// time is cut into steps, where these are shorter.
struct RotorState {
  std::vector<double> felt;    ///< Tensions at the axes as rotors feel them, N.
  std::vector<double> behind;  ///< By how much each is behind, microsteps.
  std::vector<double> lost;    ///< By how much it will be, when it has fallen back: whole turns of its field.
};

/// Of motors at rest under these tensions, N; empty without a drive.
[[nodiscard]] RotorState rotors_at_rest(const RodInputs& inputs, const std::vector<double>& tensions);

/// Goes on by `h` s up to `time`, with the tensions of that time, N.
void turn_rotors(RotorState& rotors, const RodInputs& inputs, const std::vector<double>& tensions,
                 double time, double h);

/// Whether any falls back, or may soon under these tensions, N.
[[nodiscard]] bool are_strained(const RotorState& rotors, const RodInputs& inputs,
                                const std::vector<double>& tensions, double time);

}  // namespace flexura
