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
      targets_(drive.axes.size(), 0.0) {
  const std::vector<double> exact = motor_positions(drive, start);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    sides_[i].farthest = sense(axes_[i]) * exact[i];
    command(i, sides_[i].farthest);
  }
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
  require_one_an_axis(axes_.size(), desired.pulled.size());
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const double target = desired.pulled[i] * axes_[i].microsteps_a_metre();
    Side& side = sides_[i];
    const double ahead = side.letting_out ? side.farthest - target : target - side.farthest;
    if (ahead < -rounding) side.letting_out = !side.letting_out;
    if (ahead > 0 || ahead < -rounding) side.farthest = target;
    command(i, side.letting_out ? target - axes_[i].backlash_steps() : target);
  }
}

}  // namespace flexura
