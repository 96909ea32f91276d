#include "flexura/equipment/cia402_ramp.h"

#include <algorithm>
#include <cmath>

namespace flexura {

const Cia402Ramp::Phase* Cia402Ramp::phase_at(double now) const {
  if (now >= end_) return nullptr;
  const auto after = std::ranges::upper_bound(phases_, now, {}, &Phase::start);
  return after == phases_.begin() ? nullptr : &*(after - 1);
}

double Cia402Ramp::position(double now) const {
  const Phase* phase = phase_at(now);
  if (phase == nullptr) return now < end_ && !phases_.empty() ? phases_.front().position : target_;
  const double t = now - phase->start;
  return phase->position + t * (phase->velocity + 0.5 * phase->acceleration * t);
}

double Cia402Ramp::velocity(double now) const {
  const Phase* phase = phase_at(now);
  return phase == nullptr ? 0 : phase->velocity + phase->acceleration * (now - phase->start);
}

void Cia402Ramp::set(double now, double position, double velocity) {
  target_ = position;
  phases_.clear();
  end_ = velocity == 0 ? now : HUGE_VAL;
  if (velocity != 0) phases_.push_back({now, position, velocity, 0});
}

void Cia402Ramp::add(double duration, double acceleration) {
  if (!(duration > 0)) return;
  phases_.push_back({end_, next_position_, next_velocity_, acceleration});
  next_position_ += duration * (next_velocity_ + 0.5 * acceleration * duration);
  next_velocity_ += duration * acceleration;
  end_ += duration;
}

void Cia402Ramp::stop(double now, double deceleration) {
  next_position_ = position(now), next_velocity_ = velocity(now);
  phases_.clear();
  end_ = now;
  add(std::abs(next_velocity_) / deceleration, std::copysign(deceleration, -next_velocity_));
  target_ = next_position_;
}

void Cia402Ramp::move(double now, double target, double speed, double acceleration, double deceleration) {
  next_position_ = position(now), next_velocity_ = velocity(now);
  phases_.clear();
  end_ = now;
  const double v = next_velocity_;
  const double stopped = next_position_ + v * std::abs(v) / (2 * deceleration);
  if (v * (target - stopped) < 0 || v * (target - next_position_) < 0) {
    // It moves away, or too fast to stop in time.
    add(std::abs(v) / deceleration, std::copysign(deceleration, -v));
    next_velocity_ = 0;
  }
  const double direction = target < next_position_ ? -1 : 1;
  const double distance = std::abs(target - next_position_);
  const double start = std::abs(next_velocity_);
  const double highest = std::sqrt((distance + start * start / (2 * acceleration)) * 2 * acceleration *
                                   deceleration / (acceleration + deceleration));
  const double peak = start > speed ? speed : std::min(speed, std::max(highest, start));
  if (start > peak) {
    add((start - peak) / deceleration, -direction * deceleration);
  } else {
    add((peak - start) / acceleration, direction * acceleration);
  }
  const double left = std::abs(target - next_position_) - peak * peak / (2 * deceleration);
  next_velocity_ = direction * peak;
  if (peak > 0) add(left / peak, 0);
  add(peak / deceleration, -direction * deceleration);
  target_ = target;
}

double cia402_speed(double distance, double velocity, double duration, double acceleration, double most) {
  double v0 = velocity;
  if (distance < 0) distance = -distance, v0 = -v0;
  if (v0 < 0) {
    // First it must brake, which takes it further away.
    duration += v0 / acceleration;
    distance += v0 * v0 / (2 * acceleration);
    v0 = 0;
  }
  // Speeds up to v >= v0: distance = v (duration + v0 / a) - v^2 / a - v0^2 / (2 a).
  const double b = duration + v0 / acceleration, c = distance + v0 * v0 / (2 * acceleration);
  const double root = b * b - 4 * c / acceleration;
  if (!(duration > 0) || root < 0) return most;
  double speed = acceleration * (b - std::sqrt(root)) / 2;
  if (speed < v0) {
    // Slows down to v < v0: distance = v0^2 / (2 a) + v (duration - v0 / a).
    const double time = duration - v0 / acceleration;
    speed = time > 0 ? (distance - v0 * v0 / (2 * acceleration)) / time : most;
  }
  return speed > 0 ? std::min(speed, most) : most;
}

}  // namespace flexura
