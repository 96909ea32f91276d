#include "flexura/rig/commanded_motion.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "flexura/model/arm_difference.h"

namespace flexura {

CommandedMotion::CommandedMotion(double start, ArmState state) : start_(start) {
  states_.push_back(std::move(state));
}

void CommandedMotion::send(double time, const ArmState& state, double duration) {
  const ArmState from = at(time);
  while (times_.size() > 1 && times_.back() > time - start_) times_.pop_back(), states_.pop_back();
  if (time - start_ > times_.back()) times_.push_back(time - start_), states_.push_back(from);
  times_.push_back(times_.back() + duration), states_.push_back(state);
}

ArmState CommandedMotion::at(double time) const {
  const double t = time - start_;
  const auto after = std::ranges::upper_bound(times_, t);
  if (after == times_.end()) return states_.back();
  if (after == times_.begin()) return states_.front();
  const auto i = static_cast<std::size_t>(after - times_.begin());
  const double share = (t - times_[i - 1]) / (times_[i] - times_[i - 1]);
  return plus(states_[i - 1], minus(states_[i], states_[i - 1]), share);
}

MotionPtr CommandedMotion::motion(double time) const {
  std::vector<double> times = times_;
  std::vector<ArmState> states = states_;
  while (times.size() > 1 && times.back() >= time - start_) times.pop_back(), states.pop_back();
  if (!(time > start_)) return hold_motion(states.back(), 0);
  times.push_back(time - start_), states.push_back(at(time));
  return keyframe_motion(std::move(times), states, Interpolation::linear);
}

RecordedPorts::RecordedPorts(const RigPorts& ports, ArmState from, const RecordSteps& record)
    : clock_(*ports.clock), ports_(ports), motion_(clock_.now(), std::move(from)), record_(record) {
  ports_.clock = this;
}

// Waiting for a camera takes time too, which the clock's waits do not include.
double RecordedPorts::finish() {
  const double end = now();
  record_up_to(end);
  return end;
}

void RecordedPorts::wait_until(double time) {
  clock_.wait_until(time);
  record_up_to(now());
}

void RecordedPorts::record_up_to(double time) {
  record_(time, [this](double at) { return motion_.at(at); });
}

}  // namespace flexura
