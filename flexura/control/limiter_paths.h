#pragma once

#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/drive.h"

// Computations of a limiter with states and motors.
namespace flexura {

/// Returns true if the state has one bend and one stretch per section of the arm.
[[nodiscard]] bool fits(const Arm& arm, const ArmState& state);

/// Returns `next` and the states from there to rest, at rates that decrease evenly from (next - now) per
/// step: count >= 1 states.
[[nodiscard]] std::vector<ArmState> path_of(const ArmState& now, const ArmState& next, int count);

/// Returns the highest rate of motor and controller, microsteps/s.
[[nodiscard]] double motor_rate(const StepperMotor& motor);

/// Returns the largest acceleration, microsteps/s^2.
[[nodiscard]] double motor_acceleration(const StepperMotor& motor);

}  // namespace flexura
