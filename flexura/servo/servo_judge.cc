#include "flexura/servo/servo_judge.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "flexura/model/backbone.h"

namespace flexura {

void ServoJudge::add(const ServoStep& step) {
  // Recent time for which the limiter held the law back. It decreases as fast while the limiter does not.
  limited_for_ = std::clamp(limited_for_ + (step.limited.empty() ? -1 : 1) * config_.step, 0.0, 1.0);
  if (!step.limited.empty()) limited_by_ = step.limited;
  if (step.is_fresh) is_singular_ = step.is_singular;
  if (step.is_fresh && step.error) {
    add_error(step);
    seen_at_ = step.time;
  } else if (step.time - seen_at_ > config_.hold_after) {
    below_since_.reset();  // Nobody knows where it was meanwhile.
  }
  if (!is_done_ && !failure_ && step.time > goal_time_ + config_.timeout) failure_ = why_not();
}

void ServoJudge::add_error(const ServoStep& step) {
  latest_ = step.error->rms;
  const double time = *step.seen_at;
  // A low-confidence observation does not count as arrival. Pending commands to another shape do not either.
  const double uncertain = 2 * config_.tolerance;
  const bool stays = step.sigma <= uncertain && (!step.ahead || step.ahead->rms <= uncertain);
  if (time < goal_time_ || !(latest_ <= config_.tolerance) || !stays) {
    below_since_.reset();
  } else if (!below_since_) {
    below_since_ = time;
  }
  is_done_ = below_since_ && time - *below_since_ >= config_.settle;
  // The target may move faster than the arm is allowed to.
  const bool is_left_behind = !step.limited.empty() && step.desired != desired_;
  desired_ = step.desired;
  if (is_left_behind) best_ = latest_, worse_since_.reset();
  best_ = std::min(best_, latest_);
  constexpr double much = 3, far = 0.05, patience = 1;  // Factor on the best error; share of the length; s.
  if (!(latest_ > std::max(much * best_, best_ + far))) {
    worse_since_.reset();
  } else if (!worse_since_) {
    worse_since_ = time;
  } else if (time - *worse_since_ > patience) {
    failure_ = fmt::format("diverging: the error has grown to {:.2g} % of the length from {:.2g} %",
                           100 * latest_, 100 * best_);
    // If the arm may not turn as fast as the law requests, it passes the target again and again.
    if (limited_for_ > 0) *failure_ += fmt::format("; limited by {}", limited_by_);
  }
}

std::string ServoJudge::why_not() const {
  const std::string off =
      fmt::format("the error is still {:.3g} % of the length {:.4g} s after the target's time", 100 * latest_,
                  config_.timeout);
  constexpr double long_enough = 0.5;  // s
  if (limited_for_ > long_enough) return fmt::format("saturated: {}; {}", limited_by_, off);
  if (is_singular_) return "singular: some motion of the arm changes no feature; " + off;
  return "not settled: " + off;
}

// Updates by how much the tip went past its target, as a share of its way there.
void ServoTally::add_overshoot(const ServoStep& step) {
  const Eigen::Vector3d tip = Backbone(arm_, *step.seen).tip().position;
  if (!tip_) {
    tip_ = tip, way_ = Backbone(arm_, step.desired).tip().position - tip;
    return;
  }
  constexpr double little = 0.01;  // Share of the arm's length: shorter ways would amplify noise.
  if (way_.norm() > little * arm_.length())
    overshoot_ = std::max(overshoot_, way_.dot(tip - *tip_) / way_.squaredNorm() - 1);
}

void ServoTally::add(const ServoStep& step) {
  if (!step.is_fresh) return;
  if (step.seen && *step.seen_at >= begun_ + last_goal_) add_overshoot(step);
  if (!step.error) return;
  constexpr double near = 0.02;
  const double time = *step.seen_at - begun_;
  if (time < last_goal_ || step.error->rms > near)
    settled_.reset();
  else if (!settled_)
    settled_ = time;
  late_.add(*step.seen_at, *step.error);
}

void ServoTally::finish(ServoResult& result) const {
  result.settled = settled_, result.overshoot = overshoot_, result.remaining = late_.mean();
}

}  // namespace flexura
