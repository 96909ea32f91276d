#include "flexura/kinematics/motors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace flexura {
namespace {

// In microsteps. A smaller movement is a rounding error.
constexpr double rounding = 1e-6;
// Doubles represent all integers up to this value.
constexpr double max_position = 9007199254740992.0;

void require_one_an_axis(std::size_t axes, std::size_t given) {
  if (given != axes)
    throw std::invalid_argument(fmt::format("expected {} values, one per axis, not {}", axes, given));
}

// Positive values pull in; a reversed motor counts the other way.
double sense(const Axis& axis) { return axis.reversed ? -1.0 : 1.0; }

// Returns half of the travel that friction takes, microsteps.
double half_travel(const Axis& axis, const TendonDisplacements& displacements, std::size_t index) {
  return displacements.wraps.empty() ? 0.0 : axis.friction_steps(displacements.wraps[index]) / 2;
}

void require_fit_of(std::size_t axes, const TendonDisplacements& displacements) {
  require_one_an_axis(axes, displacements.pulled.size());
  if (!displacements.wraps.empty()) require_one_an_axis(axes, displacements.wraps.size());
}

}  // namespace

std::vector<double> motor_positions(const Drive& drive, const TendonDisplacements& displacements) {
  require_one_an_axis(drive.axes.size(), displacements.pulled.size());
  std::vector<double> positions;
  for (std::size_t i = 0; i < drive.axes.size(); ++i) {
    const Axis& axis = drive.axes[i];
    const double spool_turns = displacements.pulled[i] / (2 * std::numbers::pi * axis.spool.radius);
    positions.push_back(sense(axis) * axis.motor.resolution() * (spool_turns * axis.spool.gear));
  }
  return positions;
}

TendonDisplacements displacements_at(const Drive& drive, std::span<const double> positions) {
  require_one_an_axis(drive.axes.size(), positions.size());
  TendonDisplacements displacements;
  for (std::size_t i = 0; i < drive.axes.size(); ++i) {
    displacements.pulled.push_back(sense(drive.axes[i]) * positions[i] / drive.axes[i].microsteps_a_metre());
  }
  return displacements;
}

MotorCommander::MotorCommander(const Drive& drive, const TendonDisplacements& start)
    : axes_(drive.axes),
      sides_(drive.axes.size()),
      positions_(drive.axes.size(), 0),
      targets_(drive.axes.size(), 0.0),
      taken_up_(drive.axes.size(), 0.0) {
  require_fit_of(axes_.size(), start);
  const std::vector<double> exact = motor_positions(drive, start);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Sides& sides = sides_[i];
    sides.tendon.farthest = sense(axes_[i]) * exact[i];
    sides.spool.farthest = sides.tendon.farthest + half_travel(axes_[i], start, i);
    command(i, sides.spool.farthest);
  }
}

bool MotorCommander::Side::follow(double target) {
  const double ahead = letting_out ? farthest - target : target - farthest;
  const bool reverses = ahead < -rounding;
  if (reverses) letting_out = !letting_out;
  if (ahead > 0 || reverses) farthest = target;
  return reverses;
}

void MotorCommander::command(std::size_t axis, double target) {
  if (!(std::abs(target) < max_position)) {
    throw std::out_of_range(fmt::format("axis {}: the position {} microsteps is too large", axis, target));
  }
  targets_[axis] = sense(axes_[axis]) * target;
  // A target halfway between two microsteps keeps the previous position.
  if (std::abs(target - sense(axes_[axis]) * static_cast<double>(positions_[axis])) <= 0.5 + rounding) return;
  positions_[axis] = static_cast<std::int64_t>(sense(axes_[axis]) * std::round(target));
}

void MotorCommander::follow(const TendonDisplacements& desired) {
  require_fit_of(axes_.size(), desired);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const double target = desired.pulled[i] * axes_[i].microsteps_a_metre(),
                 half = half_travel(axes_[i], desired, i), backlash = axes_[i].backlash_steps();
    auto& [tendon, spool] = sides_[i];
    taken_up_[i] = tendon.follow(target) ? 2 * half : 0;
    const double wound = tendon.letting_out ? target - half : target + half;
    if (spool.follow(wound)) taken_up_[i] += backlash;
    command(i, spool.letting_out ? wound - backlash : wound);
  }
}

}  // namespace flexura
