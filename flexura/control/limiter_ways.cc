#include "flexura/control/limiter_ways.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

namespace flexura {

bool fits(const Arm& arm, const ArmState& state) {
  return state.bends.size() == arm.sections.size() && state.stretches.size() == arm.sections.size();
}

bool are_equal(const ArmState& a, const ArmState& b) {
  return a.bends == b.bends && a.stretches == b.stretches;
}

ArmState between(const ArmState& a, const ArmState& b, double share) {
  ArmState state = a;
  for (std::size_t i = 0; i < a.bends.size(); ++i) {
    state.bends[i] += share * (b.bends[i] - a.bends[i]);
    state.stretches[i] += share * (b.stretches[i] - a.stretches[i]);
  }
  return state;
}

std::vector<ArmState> way_of(const ArmState& now, const ArmState& next, int count) {
  std::vector<ArmState> way{next};
  for (int k = 1; k < count; ++k) {
    ArmState state = way.back();
    const double share = static_cast<double>(count - k) / count;
    for (std::size_t i = 0; i < state.bends.size(); ++i) {
      state.bends[i] += share * (next.bends[i] - now.bends[i]);
      state.stretches[i] += share * (next.stretches[i] - now.stretches[i]);
    }
    way.push_back(std::move(state));
  }
  return way;
}

double motor_rate(const StepperMotor& motor) {
  return std::min(motor.max_speed / (2 * std::numbers::pi) * motor.resolution(), motor.max_step_rate);
}

double motor_acceleration(const StepperMotor& motor) {
  return motor.max_acceleration / (2 * std::numbers::pi) * motor.resolution();
}

}  // namespace flexura
