#include "flexura/sim/rod_inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "flexura/mechanics/arm_rod.h"
#include "flexura/mechanics/rod_spring.h"
#include "flexura/sim/arm_setup.h"
#include "flexura/sim/tendon_pull.h"

namespace flexura {
namespace {

std::vector<std::int64_t> microsteps(const Eigen::VectorXd& u) {
  std::vector<std::int64_t> positions;
  for (const double position : u) positions.push_back(std::llround(position));
  return positions;
}

const ArmRod& rod_in(const PlantSetup& setup) {
  if (!setup.truth.rod) throw std::invalid_argument("the true arm is not a rod");
  if (setup.truth.drive && setup.truth.drive->axes.size() != setup.truth.rod->rod.tendons.size())
    throw std::invalid_argument(fmt::format("the arm has {} tendons: expected {}, one per axis of its drive",
                                            setup.truth.rod->rod.tendons.size(),
                                            setup.truth.drive->axes.size()));
  return *setup.truth.rod;
}

}  // namespace

RodInputs::RodInputs(const PlantSetup& setup)
    : arm_(setup.truth.arm),
      rod_(rod_in(setup).rod),
      loads_(setup.truth.rod->loads),
      drive_(setup.truth.drive),
      tight_(rod_.tendons.size(), 0.0),
      breaks_(setup.truth.rod->breaks) {
  if (drive_) {
    motors_.emplace(*drive_, *drive_, microsteps(setup.start), setup.horizon);
    shapes_.emplace(arm_, *drive_, setup.truth.initial, microsteps(setup.start), setup.horizon);
  } else {
    bends_.emplace(arm_, setup.truth.initial, setup.horizon);
    beside_.emplace(rod_.tendons.size(), setup.horizon);
  }
  if (!drive_ || drive_->pretension == 0) return;
  RodStatics statics(rod_);
  tight_ = pretension_displacements(statics, drive_->pretension);
}

void RodInputs::command(double time, const Eigen::VectorXd& u, double duration) {
  if (motors_) {
    shapes_->advance(time, *motors_);
    motors_->command(time, {u.data(), static_cast<std::size_t>(u.size())}, duration);
  } else {
    bends_->command(time, commanded_state(u), duration);
    beside_->back(time, bends_->end());
  }
}

void RodInputs::halt(double time) {
  if (motors_) {
    shapes_->advance(time, *motors_);
    motors_->halt(time);
  } else {
    bends_->halt(time);
    beside_->halt(time);
  }
}

std::optional<ArmState> RodInputs::pull(double time, const std::vector<double>& displacements,
                                        double duration) {
  if (!bends_) return std::nullopt;
  ArmState nearest = nearest_arcs(rod_, arm_, displacements);
  bends_->command(time, nearest, duration);
  // Arcs clamped to the sections' limits may end elsewhere.
  const ArmState end = bends_->at(std::numeric_limits<double>::max());
  std::vector<double> beside = displacements;
  const std::vector<double> by_arcs = arc_displacements(rod_, end).pulled;
  for (std::size_t i = 0; i < beside.size(); ++i) beside[i] -= by_arcs[i];
  beside_->command(time, std::move(beside), bends_->end());
  return nearest;
}

bool RodInputs::weigh(double time, bool on) {
  if (!has_loads(loads_)) return false;
  weighings_.push_back({time, on});
  return true;
}

bool RodInputs::is_weighed(double time) const {
  const auto last = std::ranges::find_if(weighings_.rbegin(), weighings_.rend(),
                                         [time](const Weighing& each) { return each.time <= time; });
  return last == weighings_.rend() || last->on;
}

bool RodInputs::is_weighed_anew(double start, double end) const {
  return std::ranges::any_of(weighings_,
                             [&](const Weighing& each) { return each.time > start && each.time <= end; });
}

void RodInputs::push(double time, const std::optional<PlantPush>& push) {
  std::optional<PointSpring> spring;
  if (push) spring = spring_of(*push);
  // A push is updated more often than the arm is advanced: replace an entry of the same or a later time.
  if (!pushings_.empty() && pushings_.back().time >= time) pushings_.pop_back();
  pushings_.push_back({time, push, spring});
}

PointSpring RodInputs::spring_of(const PlantPush& push) const {
  constexpr double rounding = 1e-9;  // Part of the arm's length.
  const double length = rod_.length();
  const bool is_on_arm = push.s_rest >= -rounding * length && push.s_rest <= (1 + rounding) * length;
  if (!is_on_arm)
    throw std::invalid_argument(fmt::format("a push at s = {}: expected 0 to {:.6g} m", push.s_rest, length));
  PointSpring spring{.stiffness = push.stiffness, .most = push.most};
  double left = push.s_rest;
  while (spring.section + 1 < rod_.sections.size() && left > rod_.sections[spring.section].length)
    left -= rod_.sections[spring.section++].length;
  spring.at = std::clamp(left / rod_.sections[spring.section].length, 0.0, 1.0);
  const Pose X_BW = arm_.X_WB.inverse();
  spring.to = X_BW * push.to;
  spring.force = X_BW.rotation * push.force;
  if (const std::string problem = spring_problem(spring); !problem.empty())
    throw std::invalid_argument(problem);
  return spring;
}

const RodInputs::Pushing* RodInputs::pushing(double time) const {
  const auto last = std::ranges::find_if(pushings_.rbegin(), pushings_.rend(),
                                         [time](const Pushing& each) { return each.time <= time; });
  return last == pushings_.rend() ? nullptr : &*last;
}

std::optional<PlantPush> RodInputs::pushed(double time) const {
  const Pushing* last = pushing(time);
  return last == nullptr ? std::nullopt : last->push;
}

std::optional<PointSpring> RodInputs::spring(double time) const {
  const Pushing* last = pushing(time);
  return last == nullptr ? std::nullopt : last->spring;
}

bool RodInputs::is_pushed_anew(double start, double end) const {
  return std::ranges::any_of(pushings_,
                             [&](const Pushing& each) { return each.time > start && each.time <= end; });
}

void RodInputs::forget_before(double time) {
  if (motors_) shapes_->forget_before(time, *motors_);
  // The last entry before `time` still applies.
  while (pushings_.size() > 1 && pushings_[1].time < time) pushings_.erase(pushings_.begin());
  while (weighings_.size() > 1 && weighings_[1].time < time) weighings_.erase(weighings_.begin());
}

std::optional<ArmState> RodInputs::commanded(double time) const {
  if (motors_) return shapes_->at(time, *motors_);
  return bends_->at(time);
}

std::vector<double> RodInputs::pulled(double time) const {
  if (motors_) return shapes_->spools(time, *motors_);
  std::vector<double> pulled = arc_displacements(rod_, bends_->at(time)).pulled;
  beside_->add_to(pulled, time);
  return pulled;
}

std::vector<double> RodInputs::nothing_lost() const {
  return std::vector<double>(drive_ ? rod_.tendons.size() : 0, 0.0);
}

std::vector<double> RodInputs::displacements(double time, const std::vector<double>& lost) const {
  std::vector<double> given = pulled(time);
  for (std::size_t i = 0; i < given.size(); ++i) {
    given[i] += tight_[i];
    if (drive_) given[i] -= lost[i] / drive_->axes[i].microsteps_a_metre();
  }
  return after_breaks({.displacements = std::move(given)}, breaks_, time).displacements;
}

std::vector<double> RodInputs::rest_stretches(double time) const {
  if (bends_) return bends_->at(time).stretches;
  return std::vector<double>(arm_.sections.size(), 1.0);
}

bool RodInputs::can_stretch() const {
  return bends_ && std::ranges::any_of(arm_.sections, &Section::can_stretch);
}

std::vector<double> RodInputs::events(double start, double end) const {
  std::vector<double> times;
  for (const TendonBreak& each : breaks_)
    if (each.time > start && each.time < end) times.push_back(each.time);
  for (const Weighing& each : weighings_)
    if (each.time > start && each.time < end) times.push_back(each.time);
  return times;
}

const RodLoads& RodInputs::loads(double time) const {
  static const RodLoads none;
  return is_weighed(time) ? loads_ : none;
}

bool RodInputs::may_lose_steps() const {
  return drive_ && std::ranges::any_of(drive_->axes, [](const Axis& axis) {
           return std::isfinite(axis.motor.pull_out_torque(0));
         });
}

std::vector<char> RodInputs::overloaded(double time, const std::vector<double>& tensions, double part) const {
  std::vector<char> result;
  if (!drive_) return result;
  const std::vector<double> rates = motors_->rates(time);
  for (std::size_t i = 0; i < drive_->axes.size(); ++i) {
    const Axis& axis = drive_->axes[i];
    const double speed = std::abs(rates[i]) * 2 * std::numbers::pi / axis.motor.resolution();
    result.push_back(axis.torque(tensions[i]) > part * axis.motor.pull_out_torque(speed) ? 1 : 0);
  }
  return result;
}

double RodInputs::field_turn(std::size_t axis) const { return drive_.value().axes[axis].motor.field_turn(); }

bool RodInputs::lose_steps(double time, const std::vector<double>& tensions,
                           std::vector<double>& lost) const {
  const std::vector<char> over = overloaded(time, tensions);
  for (std::size_t i = 0; i < over.size(); ++i)
    if (over[i] != 0) lost[i] += field_turn(i);
  return std::ranges::any_of(over, [](char each) { return each != 0; });
}

}  // namespace flexura
