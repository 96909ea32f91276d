#include "flexura/experiment/schedule.h"

#include <algorithm>
#include <cmath>

#include "flexura/kinematics/shape.h"
#include "flexura/safety/motion_check.h"

namespace flexura {
Schedule::Schedule(const Experiment& experiment)
    : arm_(experiment.arm.arm()),
      initial_(arm_state(arm_, experiment.arm.initial)),
      obstacles_(obstacles(experiment.obstacle)),
      step_(experiment.clock.step) {
  ArmState state = initial_;
  for (const TaskConfig& task : experiment.task) {
    const MotionPtr motion = task_motion(task, arm_, state);
    legs_.push_back({task_name(task), std::string(task_kind(task)), duration_, motion});
    state = motion->at(motion->duration());
    duration_ += motion->duration();
  }
  if (legs_.empty()) legs_.push_back({"start", "hold", 0.0, hold_motion(state, 0.0)});
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
  return leg.motion->at(std::clamp(time - leg.start, 0.0, leg.motion->duration()));
}

SafetyReport Schedule::check() const {
  std::vector<TimedMotion> motions;
  for (const Leg& leg : legs_) motions.push_back({leg.motion, leg.start});
  return check_motions(arm_, obstacles_, initial_, motions, step_);
}

}  // namespace flexura
