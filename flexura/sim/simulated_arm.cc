#include "flexura/sim/simulated_arm.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/sim/start_command.h"

namespace flexura {
namespace {

void require_same_kind(const ArmSetup& model, const ArmSetup& truth) {
  if (model.arm.sections.size() != truth.arm.sections.size() ||
      model.drive.has_value() != truth.drive.has_value() ||
      (model.drive && model.drive->axes.size() != truth.drive->axes.size()))
    throw std::invalid_argument(
        "the sections or axes of the true arm do not match the sections or axes of the model");
}

}  // namespace

SimulatedBends::SimulatedBends(const ArmSetup& model, const ArmSetup& truth, Plant& plant,
                               const ClockPort& clock, double horizon)
    : link_("the arm", clock),
      arm_(truth.arm),
      bends_(truth.arm, truth.initial, horizon),
      offset_(minus(truth.initial, model.initial)),
      plant_(plant) {}

CommandOutcome SimulatedBends::command(const ArmState& state, double duration) {
  if (auto fault = link_.fault()) return *fault;
  if (const std::string problem = command_problem(arm_, state, duration); !problem.empty())
    return link_.refusal(problem);
  const ArmState target = plus(state, offset_);
  bends_.command(link_.now(), target, duration);
  plant_.command(link_.now(), plant_command(target), duration);
  return Accepted{};
}

CommandOutcome SimulatedBends::halt() {
  if (auto fault = link_.fault()) return *fault;
  bends_.halt(link_.now());
  plant_.halt(link_.now());
  return Accepted{};
}

Outcome<ArmReading> SimulatedBends::read() {
  if (auto fault = link_.fault()) return *fault;
  const double now = link_.now();
  return ArmReading{now, plus(bends_.at(now), offset_, -1), {}, bends_.is_moving(now)};
}

CommandOutcome SimulatedBends::pull(const std::vector<double>& displacements, double duration) {
  if (auto fault = link_.fault()) return *fault;
  if (!std::isfinite(duration) || duration < 0)
    return link_.refusal(fmt::format("a motion cannot take {} s", duration));
  std::optional<ArmState> target;
  try {
    target = plant_.pull(link_.now(), displacements, duration);
  } catch (const std::invalid_argument& error) {
    return link_.refusal(error.what());
  }
  if (!target) return link_.refusal("the arm has no tendons to pull");
  bends_.command(link_.now(), *target, duration);
  return Accepted{};
}

Eigen::VectorXd start_command(const ArmSetup& model, const ArmSetup& truth) {
  if (!truth.drive) return plant_command(truth.initial);
  const std::vector<std::int64_t> start = nominal_positions(model.arm, model.drive.value(), model.initial);
  Eigen::VectorXd u(static_cast<Eigen::Index>(start.size()));
  for (std::size_t i = 0; i < start.size(); ++i)
    u[static_cast<Eigen::Index>(i)] = static_cast<double>(start[i]);
  return u;
}

SimulatedArm::SimulatedArm(const ArmSetup& model, const ArmSetup& truth, const ClockPort& clock,
                           double horizon, const MakePlant& make_plant) {
  require_same_kind(model, truth);
  plant_ = make_plant({truth, start_command(model, truth), horizon});
  if (!truth.drive) {
    port_ = &bends_.emplace(model, truth, *plant_, clock, horizon);
    return;
  }
  const std::vector<std::int64_t> start = nominal_positions(model.arm, *model.drive, model.initial);
  drive_.emplace(*model.drive, *truth.drive, start, *plant_, clock, horizon);
  port_ = &driven_.emplace(*drive_, model.arm, *model.drive, model.initial);
}

CommandOutcome SimulatedArm::command(const ArmState& state, double duration) {
  return port_->command(state, duration);
}

CommandOutcome SimulatedArm::pull(const std::vector<double>& displacements, double duration) {
  return driven_ ? driven_->pull(displacements, duration) : bends_->pull(displacements, duration);
}

CommandOutcome SimulatedArm::halt() { return port_->halt(); }

Outcome<ArmReading> SimulatedArm::read() { return port_->read(); }

ArmState SimulatedArm::truth(double time) const {
  const std::optional<ArmState> state = plant_->commanded(time);
  if (!state) throw std::logic_error("the simulated drives do not impose bends: there is no state to return");
  return *state;
}

}  // namespace flexura
