#pragma once

#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/drive.h"

// Functions of the limiter for states and motors.
namespace flexura {

/// Returns true if the state has one bend and one stretch per section of the arm.
[[nodiscard]] bool fits(const Arm& arm, const ArmState& state);

/// Returns `count` >= 1 states: `next`, then the states of a braking path to rest. The change per step
/// decreases linearly from next - now.
[[nodiscard]] std::vector<ArmState> path_of(const ArmState& now, const ArmState& next, int count);

/// Returns the highest rate that both motor and controller allow, microsteps/s.
[[nodiscard]] double motor_rate(const StepperMotor& motor);

/// Returns the largest acceleration of the motor, microsteps/s^2.
[[nodiscard]] double motor_acceleration(const StepperMotor& motor);

}  // namespace flexura
