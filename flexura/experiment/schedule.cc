#include "flexura/experiment/schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "flexura/kinematics/shape.h"

namespace flexura {
namespace {

// Limits are typed in degrees and bends computed in radians: a bend on its limit is not beyond it.
constexpr double limit_tolerance = 1e-9;

bool beyond(double value, double limit) { return value > limit * (1 + limit_tolerance); }

void check_bend(const Leg& leg, const Section& section, std::size_t index, std::vector<Violation>& found) {
  const double end = leg.start + leg.duration;
  const double bend = std::max(leg.from.bends[index].norm(), leg.to.bends[index].norm());
  if (beyond(bend, section.max_bend))
    found.push_back({leg.start, end, index, "bend", bend, section.max_bend});
  const double rate = (leg.to.bends[index] - leg.from.bends[index]).norm() / leg.duration;
  if (beyond(rate, section.max_bend_rate)) {
    found.push_back({leg.start, end, index, "bend rate", rate, section.max_bend_rate});
  }
}

void check_stretch(const Leg& leg, const Section& section, std::size_t index, std::vector<Violation>& found) {
  const double end = leg.start + leg.duration;
  const auto [low, high] = std::minmax(leg.from.stretches[index], leg.to.stretches[index]);
  if (beyond(high, section.stretch_limits[1])) {
    found.push_back({leg.start, end, index, "stretch", high, section.stretch_limits[1]});
  }
  if (low < section.stretch_limits[0] * (1 - limit_tolerance)) {
    found.push_back({leg.start, end, index, "stretch", low, section.stretch_limits[0]});
  }
}

}  // namespace

std::string Violation::text() const {
  const bool is_angle = what != "stretch";
  const double factor = is_angle ? 180.0 / std::numbers::pi : 1.0;
  const char* unit = what == "bend" ? " deg" : is_angle ? " deg/s" : "";
  return fmt::format("{:.6g} s to {:.6g} s: section {}: {} {:.6g}{}, limit {:.6g}{}", start, end, section + 1,
                     what, value * factor, unit, limit * factor, unit);
}

Schedule::Schedule(const Experiment& experiment) : step_(experiment.clock.step) {
  const Arm arm = experiment.arm.arm();
  ArmState state = arm_state(arm, experiment.arm.initial);
  for (const TaskConfig& task : experiment.task) {
    Leg leg{task_name(task), std::string(task_kind(task)), duration_, flexura::duration(task), state, state};
    if (const auto* move = std::get_if<MoveTask>(&task)) leg.to = arm_state(arm, move->to);
    state = leg.to;
    duration_ += leg.duration;
    legs_.push_back(std::move(leg));
  }
  if (legs_.empty()) legs_.push_back({"start", "hold", 0.0, 0.0, state, state});
  // A duration of a whole number of steps, but for rounding, takes just that many.
  constexpr double rounding = 1e-9;
  steps_ = static_cast<std::size_t>(std::max(0.0, std::ceil(duration_ / step_ - rounding)));
}

double Schedule::time_of_step(std::size_t step) const {
  return step == steps_ ? duration_ : static_cast<double>(step) * step_;
}

std::size_t Schedule::leg_at(double time) const {
  const auto after = std::ranges::upper_bound(legs_, time, {}, &Leg::start);
  return after == legs_.begin() ? 0 : static_cast<std::size_t>(after - legs_.begin()) - 1;
}

ArmState Schedule::state_at(double time) const {
  const Leg& leg = legs_[leg_at(time)];
  const double end = leg.start + leg.duration;
  if (time >= end) return leg.to;
  return interpolate(leg.from, leg.to, (time - leg.start) / leg.duration);
}

std::vector<Violation> Schedule::violations(const Arm& arm) const {
  std::vector<Violation> found;
  for (const Leg& leg : legs_) {
    for (std::size_t i = 0; i < arm.sections.size(); ++i) {
      check_bend(leg, arm.sections[i], i, found);
      check_stretch(leg, arm.sections[i], i, found);
    }
  }
  return found;
}

}  // namespace flexura
