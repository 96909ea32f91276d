#include "flexura/control/limiter_paths.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include "flexura/model/arm_difference.h"

namespace flexura {

bool fits(const Arm& arm, const ArmState& state) {
  return state.bends.size() == arm.sections.size() && state.stretches.size() == arm.sections.size();
}

std::vector<ArmState> path_of(const ArmState& now, const ArmState& next, int count) {
  std::vector<ArmState> way{next};
  const ArmDifference going_on = minus(next, now);
  for (int k = 1; k < count; ++k) {
    const double share = static_cast<double>(count - k) / count;
    way.push_back(plus(way.back(), going_on, share));
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
