#include "flexura/sim/simulated_drive.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace flexura {

SimulatedDrive::SimulatedDrive(const Drive& nominal, const Drive& real,
                               const std::vector<std::int64_t>& start, Plant& plant, const ClockPort& clock,
                               double horizon)
    : link_("the arm", clock), motors_(nominal, real, start, horizon), plant_(plant) {}

CommandOutcome SimulatedDrive::command(std::span<const double> targets, double duration) {
  if (auto fault = link_.fault()) return *fault;
  if (targets.size() != axes())
    return link_.refusal(fmt::format("{} targets for {} axes", targets.size(), axes()));
  if (!std::ranges::all_of(targets, [](double target) { return std::isfinite(target); }))
    return link_.refusal("a position is not a finite number");
  if (!std::isfinite(duration) || duration < 0)
    return link_.refusal(fmt::format("a motion cannot take {} s", duration));
  motors_.command(link_.now(), targets, duration);
  plant_.command(link_.now(),
                 Eigen::Map<const Eigen::VectorXd>(targets.data(), static_cast<Eigen::Index>(targets.size())),
                 duration);
  return Accepted{};
}

CommandOutcome SimulatedDrive::halt() {
  if (auto fault = link_.fault()) return *fault;
  motors_.halt(link_.now());
  plant_.halt(link_.now());
  return Accepted{};
}

Outcome<DriveReading> SimulatedDrive::read() {
  if (auto fault = link_.fault()) return *fault;
  const double now = link_.now();
  return DriveReading{now, motors_.positions(now), motors_.carried(now), motors_.is_moving(now)};
}

}  // namespace flexura
