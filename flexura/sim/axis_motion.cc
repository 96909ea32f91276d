#include "flexura/sim/axis_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

namespace flexura {

AxisMotion::State AxisMotion::Plan::at(double time) const {
  if (time >= end || count == 0) return {target, 0};
  int i = count - 1;
  while (i > 0 && pieces[static_cast<std::size_t>(i)].start > time) --i;
  const Piece& piece = pieces[static_cast<std::size_t>(i)];
  const double t = std::max(time - piece.start, 0.0);
  return {piece.position + t * (piece.rate + 0.5 * t * piece.acceleration),
          piece.rate + t * piece.acceleration};
}

// Appends a piece of this duration, rate and acceleration at `end`, and moves `end` and `target` to its end.
void AxisMotion::Plan::add(double duration, double rate, double acceleration) {
  pieces[static_cast<std::size_t>(count++)] = {end, target, rate, acceleration};
  end += duration;
  target += duration * (rate + 0.5 * duration * acceleration);
}

AxisMotion::AxisMotion(const AxisConfig& axis, const Backlash& backlash, double start, double delay,
                       double horizon)
    : axis_(axis), backlash_(backlash), delay_(delay), horizon_(horizon) {
  Plan& rest = plans_.emplace_back();
  rest.start = rest.end = rest.turn = -std::numeric_limits<double>::infinity();
  rest.target = rest.carried = start;
}

void AxisMotion::command(double time, double target, double duration) {
  if (!std::isfinite(target))
    throw std::invalid_argument(fmt::format("an axis cannot move to {}: expected a finite position", target));
  go(time, commandable(axis_, target), duration);
}

void AxisMotion::halt(double time) {
  const State now = plans_.back().at(time + delay_);
  go(time, now.position + now.rate * std::abs(now.rate) / (2 * axis_.max_acceleration), 0);
}

void AxisMotion::go(double time, double target, double duration) {
  const double start = time + delay_;
  if (!std::isfinite(start) || start < plans_.back().start)
    throw std::invalid_argument(
        fmt::format("a command at {} s is before the last command, which takes effect at {} s", time,
                    plans_.back().start));
  const State from = plans_.back().at(start);
  Plan plan;
  plan.start = plan.end = plan.turn = start;
  plan.carried = carried(plans_.back(), start);
  plan.target = from.position;
  if (target != from.position || from.rate != 0) fill(plan, from, target, duration);
  plans_.push_back(plan);
  while (plans_.size() > 1 && plans_[1].start <= time - horizon_) plans_.pop_front();
}

// Returns the peak rate to which the axis accelerates or decelerates from `rate`. With this peak rate it
// comes to rest after the distance `way` and the time `duration`, or as soon as possible. `way` is at least
// the braking distance.
double AxisMotion::peak_rate(double way, double rate, double duration) const {
  const double a = axis_.max_acceleration;
  const double peak = std::min(std::sqrt(std::max(a * way + 0.5 * rate * rate, 0.0)), axis_.max_rate);
  if (!(peak > 0)) return 0;  // Braking now ends exactly at the target.
  const double reach =
      // From the point where it started at rest, or will reverse.
      std::max(way + rate * rate / (2 * a), 0.0);
  const double shortest = (peak - rate) / a + reach / peak;
  if (!(duration > shortest)) return peak;
  // Slowing down first: braking takes rate/a, and the remaining time passes at constant rate.
  const double slowed = (way - rate * rate / (2 * a)) / (duration - rate / a);
  if (rate > 0 && slowed <= rate) return std::max(slowed, 0.0);
  // Speeding up first: the smaller root of duration = (peak - rate)/a + reach/peak.
  const double half = 0.5 * (duration + rate / a);
  return std::min(reach / (half + std::sqrt(std::max(half * half - reach / a, 0.0))), peak);
}

// Plans the motion from a position and rate to rest at `target`: full acceleration to the peak rate, constant
// rate, full deceleration.
void AxisMotion::fill(Plan& plan, const State& from, double target, double duration) const {
  const double a = axis_.max_acceleration;
  if (std::isinf(a)) {
    const double way = target - from.position;
    const double lasts = std::max(std::abs(way) / axis_.max_rate, duration);
    plan.add(lasts, lasts > 0 ? way / lasts : 0, 0);
    plan.target = target;
    return;
  }
  // Signs are relative to the direction in which distance remains if the axis braked now.
  const double left = target - (from.position + from.rate * std::abs(from.rate) / (2 * a));
  const double sense = std::copysign(1.0, left);
  const double way = sense * (target - from.position), rate = sense * from.rate;
  const double peak = peak_rate(way, rate, duration);
  const double faster = peak < rate ? -1 : 1;  // -1: slow down first.
  const double cruise = way - (faster * (peak * peak - rate * rate) + peak * peak) / (2 * a);
  plan.add(faster * (peak - rate) / a, sense * rate, faster * sense * a);
  if (peak > 0 && cruise > 0) plan.add(cruise / peak, sense * peak, 0);
  plan.add(peak / a, sense * peak, -sense * a);
  if (rate < 0) plan.turn = plan.start - rate / a;
  plan.target = target;  // Exact to the bit.
}

const AxisMotion::Plan& AxisMotion::plan_at(double time) const {
  const auto after = std::ranges::upper_bound(plans_, time, {}, &Plan::start);
  return after == plans_.begin() ? plans_.front() : *(after - 1);
}

double AxisMotion::carried(const Plan& plan, double time) const {
  const auto follow = [&](double position, double motor) {
    return std::clamp(position, motor + backlash_.low, motor + backlash_.high);
  };
  double position = plan.carried;
  if (plan.turn > plan.start && plan.turn < time) position = follow(position, plan.at(plan.turn).position);
  return follow(position, plan.at(time).position);
}

}  // namespace flexura
