#include "flexura/sim/drive_motors.h"

#include <algorithm>
#include <numbers>

namespace flexura {
namespace {

// A motor as an axis in microsteps.
AxisConfig axis_config(const StepperMotor& motor) {
  const double microsteps_a_radian = motor.resolution() / (2 * std::numbers::pi);
  AxisConfig axis;
  axis.limits = {-motor.max_position, motor.max_position};
  axis.max_rate = std::min(motor.max_step_rate, motor.max_speed * microsteps_a_radian);
  axis.max_acceleration = motor.max_acceleration * microsteps_a_radian;
  return axis;
}

}  // namespace

DriveMotors::DriveMotors(const Drive& drive, const Drive& real, const std::vector<std::int64_t>& start,
                         double horizon) {
  for (std::size_t i = 0; i < drive.axes.size(); ++i) {
    const Axis& axis = drive.axes[i];
    senses_.push_back(axis.reversed ? -1 : 1);
    // Play is taken up for pulling in at the start.
    motions_.emplace_back(axis_config(real.axes.at(i).motor), AxisMotion::Backlash{0, axis.backlash_steps()},
                          senses_[i] * static_cast<double>(start.at(i)), 0.0, horizon);
  }
}

void DriveMotors::command(double time, std::span<const double> positions, double duration) {
  for (std::size_t i = 0; i < motions_.size(); ++i)
    motions_[i].command(time, senses_[i] * positions[i], duration);
}

void DriveMotors::halt(double time) {
  for (AxisMotion& motion : motions_) motion.halt(time);
}

std::vector<double> DriveMotors::positions(double time) const {
  std::vector<double> result;
  result.reserve(motions_.size());
  for (std::size_t i = 0; i < motions_.size(); ++i) result.push_back(senses_[i] * motions_[i].motor(time));
  return result;
}

std::vector<double> DriveMotors::rates(double time) const {
  std::vector<double> result;
  result.reserve(motions_.size());
  for (std::size_t i = 0; i < motions_.size(); ++i) result.push_back(senses_[i] * motions_[i].rate(time));
  return result;
}

std::vector<double> DriveMotors::carried(double time) const {
  std::vector<double> result;
  result.reserve(motions_.size());
  for (std::size_t i = 0; i < motions_.size(); ++i) result.push_back(senses_[i] * motions_[i].position(time));
  return result;
}

bool DriveMotors::is_moving(double time) const {
  return std::ranges::any_of(motions_, [&](const AxisMotion& motion) { return motion.is_moving(time); });
}

}  // namespace flexura
