#include "flexura/model/drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flexura {

Eigen::Vector2d Tendon::offset() const { return {radius * std::cos(angle), radius * std::sin(angle)}; }

double StepperMotor::pull_out_torque(double speed) const {
  if (!pull_out) return std::numeric_limits<double>::infinity();
  const auto& curve = *pull_out;
  const auto after = std::ranges::upper_bound(curve, speed, {}, [](const auto& point) { return point[0]; });
  if (after == curve.begin()) return curve.front()[1];
  if (after == curve.end()) return curve.back()[1];
  const auto& before = *(after - 1);
  const double part = (speed - before[0]) / ((*after)[0] - before[0]);
  return before[1] + part * ((*after)[1] - before[1]);
}

double Axis::microsteps_a_metre() const {
  return motor.resolution() * spool.gear / (2 * std::numbers::pi * spool.radius);
}

double Axis::backlash_steps() const {
  return motor.resolution() * spool.gear * (spool.backlash / (2 * std::numbers::pi));
}

double Axis::friction_steps(double wrap) const {
  return spool.friction_travel.value_or(0) * wrap * microsteps_a_metre();
}

double Axis::max_cable_speed() const {
  return std::min(motor.max_step_rate / microsteps_a_metre(), motor.max_speed / spool.gear * spool.radius);
}

bool Drive::loses_travel() const {
  return std::ranges::any_of(axes,
                             [](const Axis& axis) { return axis.spool.friction_travel.value_or(0) > 0; });
}

std::string Drive::axis_name(std::size_t axis) const {
  return fmt::format("{}.{}", axis / axes_per_controller + 1, axis % axes_per_controller + 1);
}

}  // namespace flexura
