#include "flexura/model/drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flexura {

Eigen::Vector2d Tendon::offset() const { return {radius * std::cos(angle), radius * std::sin(angle)}; }

double Axis::microsteps_a_metre() const {
  return motor.resolution() * spool.gear / (2 * std::numbers::pi * spool.radius);
}

double Axis::play() const {
  return motor.resolution() * spool.gear * (spool.backlash / (2 * std::numbers::pi));
}

double Axis::max_cable_speed() const {
  return std::min(motor.max_step_rate / microsteps_a_metre(), motor.max_speed / spool.gear * spool.radius);
}

std::string Drive::axis_name(std::size_t axis) const {
  return fmt::format("{}.{}", axis / axes_per_controller + 1, axis % axes_per_controller + 1);
}

}  // namespace flexura
