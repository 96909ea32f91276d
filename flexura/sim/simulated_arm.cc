#include "flexura/sim/simulated_arm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include "flexura/kinematics/tendons.h"

namespace flexura {
namespace {

double sense(const Axis& axis) { return axis.reversed ? -1 : 1; }

// A motor as an axis in microsteps.
AxisConfig axis_config(const StepperMotor& motor) {
  const double microsteps_a_radian = motor.resolution() / (2 * std::numbers::pi);
  AxisConfig axis;
  axis.limits = {-motor.max_position, motor.max_position};
  axis.max_rate = std::min(motor.max_step_rate, motor.max_speed * microsteps_a_radian);
  axis.max_acceleration = motor.max_acceleration * microsteps_a_radian;
  return axis;
}

// What pulls the tendons of `setup` by motors of `real`, which stand at `positions`.
std::vector<AxisMotion> motions(const Drive& drive, const Drive& real,
                                const std::vector<std::int64_t>& positions, double horizon) {
  std::vector<AxisMotion> result;
  for (std::size_t i = 0; i < drive.axes.size(); ++i) {
    const Axis& axis = drive.axes[i];
    // Play is taken up for pulling in at the start.
    result.emplace_back(axis_config(real.axes[i].motor), AxisMotion::Play{0, axis.play()},
                        sense(axis) * static_cast<double>(positions[i]), 0.0, horizon);
  }
  return result;
}

// The displacements that motors at 0 leave when those at `positions` make the initial shape.
std::vector<double> zeros(const ArmSetup& setup, const std::vector<std::int64_t>& positions) {
  std::vector<double> result = tendon_displacements(setup.arm, *setup.drive, setup.initial).pulled;
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Axis& axis = setup.drive->axes[i];
    result[i] -= sense(axis) * static_cast<double>(positions[i]) / axis.microsteps_a_metre();
  }
  return result;
}

ArmState shape(const ArmSetup& setup, const std::vector<AxisMotion>& axes, const std::vector<double>& zero,
               double time) {
  TendonDisplacements displacements;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const double pulled = axes[i].position(time) / setup.drive->axes[i].microsteps_a_metre();
    displacements.pulled.push_back(zero[i] + pulled);
  }
  return fit_state(setup.arm, *setup.drive, displacements).state;
}

bool is_shape_of(const Arm& arm, const ArmState& state) {
  return state.bends.size() == arm.sections.size() && state.stretches.size() == arm.sections.size() &&
         std::ranges::all_of(state.bends, [](const Eigen::Vector2d& bend) { return bend.allFinite(); }) &&
         std::ranges::all_of(state.stretches, [](double stretch) { return stretch > 0 && stretch < 1e6; });
}

std::variant<SimulatedDrive, BendMotion> moved_by(const ArmSetup& model, const ArmSetup& truth,
                                                  double horizon) {
  if (model.arm.sections.size() != truth.arm.sections.size() ||
      model.drive.has_value() != truth.drive.has_value() ||
      (model.drive && model.drive->axes.size() != truth.drive->axes.size()))
    throw std::invalid_argument("the true arm has other sections or axes than the model's");
  if (truth.drive) return SimulatedDrive(model, truth, horizon);
  return BendMotion(truth.arm, truth.initial, horizon);
}

}  // namespace

SimulatedDrive::SimulatedDrive(const ArmSetup& model, const ArmSetup& truth, double horizon)
    : model_(model),
      truth_(truth),
      commander_(*model.drive, tendon_displacements(model.arm, *model.drive, model.initial)),
      believed_(motions(*model.drive, *truth.drive, commander_.positions(), horizon)),
      true_(motions(*truth.drive, *truth.drive, commander_.positions(), horizon)),
      believed_zero_(zeros(model, commander_.positions())),
      true_zero_(zeros(truth, commander_.positions())) {}

bool SimulatedDrive::command(double time, const ArmState& state, double duration) {
  constexpr double most_microsteps = 1e15;
  const TendonDisplacements wanted = tendon_displacements(model_.arm, *model_.drive, state);
  for (std::size_t i = 0; i < wanted.pulled.size(); ++i) {
    if (!(std::abs(wanted.pulled[i]) * model_.drive->axes[i].microsteps_a_metre() < most_microsteps))
      return false;
  }
  commander_.follow(wanted);
  for (std::size_t i = 0; i < true_.size(); ++i) {
    const auto position = static_cast<double>(commander_.positions()[i]);
    believed_[i].command(time, sense(model_.drive->axes[i]) * position, duration);
    true_[i].command(time, sense(truth_.drive->axes[i]) * position, duration);
  }
  return true;
}

void SimulatedDrive::halt(double time) {
  for (AxisMotion& axis : believed_) axis.halt(time);
  for (AxisMotion& axis : true_) axis.halt(time);
}

ArmReading SimulatedDrive::reading(double time) const {
  ArmReading reading;
  reading.time = time;
  reading.state = shape(model_, believed_, believed_zero_, time);
  for (std::size_t i = 0; i < believed_.size(); ++i) {
    reading.positions.push_back(std::llround(sense(model_.drive->axes[i]) * believed_[i].motor(time)));
    reading.moving = reading.moving || believed_[i].is_moving(time);
  }
  return reading;
}

ArmState SimulatedDrive::truth(double time) const { return shape(truth_, true_, true_zero_, time); }

SimulatedArm::SimulatedArm(const ArmSetup& model, const ArmSetup& truth, const ClockPort& clock,
                           double horizon)
    : link_("the arm", clock), arm_(truth.arm), moved_by_(moved_by(model, truth, horizon)) {
  offset_ = minus(truth.initial, model.initial);
}

CommandOutcome SimulatedArm::command(const ArmState& state, double duration) {
  if (auto fault = link_.fault()) return *fault;
  if (!is_shape_of(arm_.driven(), state)) return link_.refusal("the shape is not one of this arm");
  if (!std::isfinite(duration) || duration < 0)
    return link_.refusal(fmt::format("a motion cannot take {} s", duration));
  if (auto* drive = std::get_if<SimulatedDrive>(&moved_by_)) {
    if (!drive->command(link_.now(), state, duration)) return link_.refusal("a motor cannot count so far");
  } else {
    std::get<BendMotion>(moved_by_).command(link_.now(), plus(state, offset_), duration);
  }
  return Accepted{};
}

CommandOutcome SimulatedArm::halt() {
  if (auto fault = link_.fault()) return *fault;
  std::visit([now = link_.now()](auto& moved) { moved.halt(now); }, moved_by_);
  return Accepted{};
}

Outcome<ArmReading> SimulatedArm::read() {
  if (auto fault = link_.fault()) return *fault;
  const double now = link_.now();
  if (const auto* drive = std::get_if<SimulatedDrive>(&moved_by_)) return drive->reading(now);
  const auto& bends = std::get<BendMotion>(moved_by_);
  return ArmReading{now, plus(bends.at(now), offset_, -1), {}, bends.is_moving(now)};
}

ArmState SimulatedArm::truth(double time) const {
  if (const auto* drive = std::get_if<SimulatedDrive>(&moved_by_)) return drive->truth(time);
  return std::get<BendMotion>(moved_by_).at(time);
}

}  // namespace flexura
