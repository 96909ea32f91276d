#include "flexura/port/driven_arm.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "flexura/kinematics/tendons.h"

namespace flexura {
namespace {

// Positive values pull in; a reversed motor counts the other way.
double sense_of(const Axis& axis) { return axis.reversed ? -1 : 1; }

bool is_shape_of(const Arm& arm, const ArmState& state) {
  return state.bends.size() == arm.sections.size() && state.stretches.size() == arm.sections.size() &&
         std::ranges::all_of(state.bends, [](const Eigen::Vector2d& bend) { return bend.allFinite(); }) &&
         std::ranges::all_of(state.stretches, [](double stretch) { return stretch > 0 && stretch < 1e6; });
}

PortFault arm_refuses(const std::string& why) { return {FaultKind::refused, "the arm: " + why}; }

bool all_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

}  // namespace

std::string command_problem(const Arm& arm, const ArmState& state, double duration) {
  if (!is_shape_of(arm, state)) return "the shape does not fit this arm";
  if (!std::isfinite(duration) || duration < 0)
    return fmt::format("a motion cannot have a duration of {} s", duration);
  return "";
}

std::vector<std::int64_t> nominal_positions(const Arm& arm, const Drive& drive, const ArmState& state) {
  return MotorCommander(drive, tendon_displacements(arm, drive, state)).positions();
}

std::vector<double> displacements_at_zero(const Arm& arm, const Drive& drive, const ArmState& state,
                                          const std::vector<std::int64_t>& positions) {
  std::vector<double> result = FrictionPlay(arm, drive, state).spools();
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Axis& axis = drive.axes.at(i);
    result[i] -= sense_of(axis) * static_cast<double>(positions.at(i)) / axis.microsteps_a_metre();
  }
  return result;
}

TendonDisplacements displacements_carried(const Drive& drive, const std::vector<double>& zero,
                                          const std::vector<double>& carried) {
  if (zero.size() != drive.axes.size() || carried.size() != drive.axes.size())
    throw std::invalid_argument(
        fmt::format("{} positions for a drive with {} axes", carried.size(), drive.axes.size()));
  TendonDisplacements displacements;
  for (std::size_t i = 0; i < carried.size(); ++i) {
    const double pulled = sense_of(drive.axes[i]) * carried[i] / drive.axes[i].microsteps_a_metre();
    displacements.pulled.push_back(zero[i] + pulled);
  }
  return displacements;
}

ArmState shape_carried(const Arm& arm, const Drive& drive, const std::vector<double>& zero,
                       const std::vector<double>& carried) {
  return fit_state(arm, drive, displacements_carried(drive, zero, carried)).state;
}

DrivenArm::DrivenArm(DrivePort& port, const Arm& arm, const Drive& drive, const ArmState& initial)
    : port_(port),
      arm_(arm),
      drive_(drive),
      commander_(drive, tendon_displacements(arm, drive, initial)),
      zero_(displacements_at_zero(arm, drive, initial, commander_.positions())),
      play_(arm, drive, initial) {
  if (port.quantity() == DriveQuantity::tendon_tensions)
    throw std::invalid_argument(
        "a drive with tension targets cannot move this arm, because no model converts tensions to shapes: "
        "expected a drive with targets for motor positions or tendon displacements");
  if (port.axes() != drive.axes.size())
    throw std::invalid_argument(fmt::format("the controller has {} axes: expected {}, as in the arm's drive",
                                            port.axes(), drive.axes.size()));
  for (std::size_t i = 0; i < drive.axes.size(); ++i)
    followed_.push_back(sense_of(drive.axes[i]) * static_cast<double>(commander_.positions()[i]));
}

CommandOutcome DrivenArm::command(const ArmState& state, double duration) {
  if (const std::string problem = command_problem(arm_, state, duration); !problem.empty())
    return arm_refuses(problem);
  return send(tendon_displacements(arm_, drive_, state), duration);
}

CommandOutcome DrivenArm::pull(const std::vector<double>& displacements, double duration) {
  TendonDisplacements desired{displacements};
  if (displacements.size() == drive_.axes.size() && all_finite(displacements) && drive_.loses_travel())
    desired.wraps = tendon_wraps(arm_, drive_, fit_state(arm_, drive_, desired).state);
  return send(desired, duration);
}

CommandOutcome DrivenArm::send(const TendonDisplacements& desired, double duration) {
  if (desired.pulled.size() != drive_.axes.size() || !all_finite(desired.pulled))
    return arm_refuses(fmt::format("expected {} finite displacements of tendons", drive_.axes.size()));
  if (!counts_motors()) return port_.command(desired.pulled, duration);
  constexpr double most_microsteps = 1e15;
  for (std::size_t i = 0; i < desired.pulled.size(); ++i)
    if (!(std::abs(desired.pulled[i]) * drive_.axes[i].microsteps_a_metre() < most_microsteps))
      return arm_refuses("a motor position is too large");
  // If the controller refuses the command, backlash and friction remain on the same side.
  MotorCommander next = commander_;
  next.follow(desired);
  const std::vector<double> targets(next.positions().begin(), next.positions().end());
  auto outcome = port_.command(targets, duration);
  if (outcome) commander_ = std::move(next);
  return outcome;
}

std::string DrivenArm::problem_of(const DriveReading& reading) const {
  if (reading.values.size() != drive_.axes.size() ||
      (!reading.carried.empty() && reading.carried.size() != drive_.axes.size()))
    return fmt::format("the drive reports {} motor positions and {} load positions: expected {}",
                       reading.values.size(), reading.carried.size(), drive_.axes.size());
  // Larger values do not fit into an integer of 64 bits.
  const auto is_counted = [](double value) { return std::abs(value) < 9e18; };
  if (!all_finite(reading.values) || !all_finite(reading.carried) ||
      !std::ranges::all_of(reading.values, is_counted))
    return "the drive reports positions that are not finite or too large";
  return "";
}

std::vector<double> DrivenArm::carried(const DriveReading& reading) {
  if (!reading.carried.empty()) return reading.carried;
  std::vector<double> result;
  for (std::size_t i = 0; i < drive_.axes.size(); ++i) {
    const double motor = sense_of(drive_.axes[i]) * reading.values[i];
    followed_[i] = std::clamp(followed_[i], motor, motor + drive_.axes[i].backlash_steps());
    result.push_back(sense_of(drive_.axes[i]) * followed_[i]);
  }
  return result;
}

Outcome<ArmReading> DrivenArm::read() {
  const auto outcome = port_.read();
  if (const auto fault = outcome.fault()) return *fault;
  const DriveReading& reported = outcome.value();
  if (const std::string problem = problem_of(reported); !problem.empty()) return arm_refuses(problem);
  ArmReading reading;
  reading.time = reported.time;
  reading.moving = reported.moving;
  if (!counts_motors()) {
    reading.state = fit_state(arm_, drive_, {reported.values}).state;
    return reading;
  }
  reading.state = play_.follow(displacements_carried(drive_, zero_, carried(reported)).pulled);
  for (const double position : reported.values) reading.positions.push_back(std::llround(position));
  return reading;
}

}  // namespace flexura
