#pragma once

#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/drive.h"

// What a limiter computes with states and motors.
namespace flexura {

/// Whether the state has one bend and one stretch a section of the arm.
[[nodiscard]] bool fits(const Arm& arm, const ArmState& state);

/// `next`, and on from it at rates that fall evenly from (next - now) a step to rest: count >= 1 states.
[[nodiscard]] std::vector<ArmState> way_of(const ArmState& now, const ArmState& next, int count);

/// The fastest that motor and controller go, microsteps/s.
[[nodiscard]] double motor_rate(const StepperMotor& motor);

/// The largest acceleration, microsteps/s^2.
[[nodiscard]] double motor_acceleration(const StepperMotor& motor);

}  // namespace flexura
