#include "flexura/sim/bend_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <utility>

namespace flexura {

BendMotion::BendMotion(const Arm& arm, const ArmState& start, double horizon)
    : sections_(arm.sections), horizon_(horizon) {
  const double ever = -std::numeric_limits<double>::infinity();
  plans_.push_back({ever, start, start, std::vector<double>(sections_.size(), 0)});
}

ArmState BendMotion::at(const Plan& plan, double time) {
  ArmState state = plan.to;
  for (std::size_t i = 0; i < plan.durations.size(); ++i) {
    if (time >= plan.start + plan.durations[i]) continue;
    const double done = std::max(time - plan.start, 0.0) / plan.durations[i];
    state.bends[i] = plan.from.bends[i] + done * (plan.to.bends[i] - plan.from.bends[i]);
    state.stretches[i] = plan.from.stretches[i] + done * (plan.to.stretches[i] - plan.from.stretches[i]);
  }
  return state;
}

ArmState BendMotion::at(double time) const {
  const auto after = std::ranges::upper_bound(plans_, time, {}, &Plan::start);
  return at(after == plans_.begin() ? plans_.front() : *(after - 1), time);
}

bool BendMotion::is_moving(double time) const {
  constexpr double rounding = 1e-9;  // s. The end is the sum of a start and a duration.
  return end() > time + rounding;
}

double BendMotion::end() const {
  const Plan& plan = plans_.back();
  return plan.start + std::ranges::max(plan.durations);
}

void BendMotion::command(double time, const ArmState& target, double duration) {
  if (target.bends.size() != sections_.size() || target.stretches.size() != sections_.size())
    throw std::invalid_argument(
        fmt::format("the shape has {} sections, but the arm has {}", target.bends.size(), sections_.size()));
  ArmState inside = target;
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const double bend = inside.bends[i].norm();
    if (!std::isfinite(bend) || !std::isfinite(inside.stretches[i]))
      throw std::invalid_argument("the shape has numbers that are not finite");
    if (bend > sections_[i].max_bend) inside.bends[i] *= sections_[i].max_bend / bend;
    const auto [least, most] = sections_[i].stretch_limits;
    inside.stretches[i] = std::clamp(inside.stretches[i], least, most);
  }
  go(time, std::move(inside), duration);
}

void BendMotion::halt(double time) { go(time, at(time), 0); }

void BendMotion::go(double time, ArmState target, double duration) {
  if (!std::isfinite(time) || time < plans_.back().start)
    throw std::invalid_argument(
        fmt::format("a command at {} s: expected a time that is not before the last command, {} s", time,
                    plans_.back().start));
  Plan plan{time, at(time), std::move(target), {}};
  for (std::size_t i = 0; i < sections_.size(); ++i)
    plan.durations.push_back(
        std::max({duration, (plan.to.bends[i] - plan.from.bends[i]).norm() / sections_[i].max_bend_rate,
                  std::abs(plan.to.stretches[i] - plan.from.stretches[i]) / sections_[i].max_stretch_rate}));
  plans_.push_back(std::move(plan));
  while (plans_.size() > 1 && plans_[1].start <= time - horizon_) plans_.pop_front();
}

}  // namespace flexura
