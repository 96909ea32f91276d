#include "flexura/sim/rotors.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flexura {
namespace {

// Fraction of the pull-out torque below which no step is lost soon.
constexpr double careless = 0.5;

bool any(const std::vector<char>& flags) {
  return std::ranges::any_of(flags, [](char each) { return each != 0; });
}

}  // namespace

RotorState rotors_at_rest(const RodInputs& inputs, const std::vector<double>& tensions) {
  const std::vector<double> none = inputs.nothing_lost();
  return {.felt = none.empty() ? none : tensions, .behind = none, .lost = none};
}

void turn_rotors(RotorState& rotors, const RodInputs& inputs, const std::vector<double>& tensions,
                 double time, double h) {
  for (std::size_t i = 0; i < rotors.felt.size(); ++i) {
    rotors.felt[i] += -std::expm1(-h / rotor_time) * (tensions[i] - rotors.felt[i]);
    rotors.behind[i] = std::min(rotors.lost[i], rotors.behind[i] + h / fall_time * inputs.field_turn(i));
  }
  const std::vector<char> over = inputs.overloaded(time, rotors.felt);
  for (std::size_t i = 0; i < over.size(); ++i)
    if (over[i] != 0 && rotors.behind[i] == rotors.lost[i]) rotors.lost[i] += inputs.field_turn(i);
}

bool are_strained(const RotorState& rotors, const RodInputs& inputs, const std::vector<double>& tensions,
                  double time) {
  return rotors.behind != rotors.lost || any(inputs.overloaded(time, tensions, careless)) ||
         any(inputs.overloaded(time, rotors.felt, careless));
}

}  // namespace flexura
