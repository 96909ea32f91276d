#include "flexura/servo/servo_judge.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "flexura/model/backbone.h"

namespace flexura {

ServoError servo_error(const Backbone& shape, const Backbone& desired, double length) {
  constexpr int count = 50;
  ServoError error;
  double squares = 0;
  for (int i = 0; i <= count; ++i) {
    const double share = static_cast<double>(i) / count;
    const double off =
        (shape.pose(share * shape.length()).position - desired.pose(share * desired.length()).position)
            .norm();
    squares += off * off / (count + 1);
    error.most = std::max(error.most, off), error.tip = off;
  }
  return {std::sqrt(squares) / length, error.most / length, error.tip / length};
}

ServoError servo_error(const Arm& arm, const ArmState& shape, const ArmState& desired) {
  return servo_error(Backbone(arm, shape), Backbone(arm, desired), arm.length());
}

void ServoJudge::add(const ServoStep& step) {
  // How long it was held back, lately: what is let go is forgotten as fast.
  limited_for_ = std::clamp(limited_for_ + (step.limited.empty() ? -1 : 1) * config_.step, 0.0, 1.0);
  if (!step.limited.empty()) limited_by_ = step.limited;
  if (step.is_fresh) is_singular_ = step.is_singular;
  if (step.is_fresh && step.error) {
    add_error(step);
    seen_at_ = step.time;
  } else if (step.time - seen_at_ > config_.patience.blind) {
    below_since_.reset();  // Nobody knows where it was meanwhile.
  }
  if (!is_done_ && !hopeless_ && step.time > goal_time_ + config_.patience.timeout) hopeless_ = why_not();
}

void ServoJudge::add_error(const ServoStep& step) {
  latest_ = step.error->rms;
  const double time = *step.seen_at;
  // What is seen badly is not yet there, and neither is what is still on its way elsewhere.
  const double doubtful = 2 * config_.tolerance;
  const bool stays = step.sigma <= doubtful && (!step.ahead || step.ahead->rms <= doubtful);
  if (time < goal_time_ || !(latest_ <= config_.tolerance) || !stays) {
    below_since_.reset();
  } else if (!below_since_) {
    below_since_ = time;
  }
  is_done_ = below_since_ && time - *below_since_ >= config_.settle;
  best_ = std::min(best_, latest_);
  constexpr double much = 3, far = 0.05, patience = 1;  // Times the best, share of the length, s.
  if (!(latest_ > std::max(much * best_, best_ + far))) {
    worse_since_.reset();
  } else if (!worse_since_) {
    worse_since_ = time;
  } else if (time - *worse_since_ > patience) {
    hopeless_ =
        fmt::format("diverging: {:.2g} % of the length off, after {:.2g} %", 100 * latest_, 100 * best_);
  }
}

std::string ServoJudge::why_not() const {
  const std::string off = fmt::format("still {:.3g} % of the length off {:.4g} s after the goal's time",
                                      100 * latest_, config_.patience.timeout);
  constexpr double long_enough = 0.5;  // s
  if (limited_for_ > long_enough) return fmt::format("saturated: {}; {}", limited_by_, off);
  if (is_singular_) return "singular: some motion of the arm shows in nothing that is seen; " + off;
  return "not settled: " + off;
}

namespace {

// By how much the tip went beyond its goal, seen from where it was, share of that way.
double overshoot_of(const Arm& arm, const ServoResult& result, double from_time) {
  const ServoStep* first = nullptr;
  double most = 0;
  Eigen::Vector3d start = Eigen::Vector3d::Zero(), way = Eigen::Vector3d::Zero();
  for (const ServoStep& step : result.steps) {
    if (!step.is_fresh || !step.seen || *step.seen_at < from_time) continue;
    const Eigen::Vector3d tip = Backbone(arm, *step.seen).tip().position;
    if (first == nullptr) {
      first = &step, start = tip, way = Backbone(arm, step.desired).tip().position - tip;
      continue;
    }
    constexpr double little = 0.01;  // Of the arm's length: ways that noise would blow up.
    if (way.norm() > little * arm.length())
      most = std::max(most, way.dot(tip - start) / way.squaredNorm() - 1);
  }
  return most;
}

}  // namespace

void add_figures(const Arm& arm, const ServoConfig& config, double last_goal, ServoResult& result) {
  constexpr double near = 0.02;
  ServoError sum;
  int count = 0;
  double latest = -1;
  for (const ServoStep& step : result.steps)
    if (step.is_fresh && step.error) latest = std::max(latest, *step.seen_at);
  for (const ServoStep& step : result.steps) {
    if (!step.is_fresh || !step.error) continue;
    const double time = *step.seen_at - result.start;
    if (time < last_goal || step.error->rms > near)
      result.settled.reset();
    else if (!result.settled)
      result.settled = time;
    if (*step.seen_at < latest - config.settle) continue;
    sum.rms += step.error->rms, sum.most += step.error->most, sum.tip += step.error->tip, ++count;
  }
  if (count > 0) result.remaining = ServoError{sum.rms / count, sum.most / count, sum.tip / count};
  result.overshoot = overshoot_of(arm, result, result.start + last_goal);
}

}  // namespace flexura
