#include "flexura/view/run_pace.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flexura {

void RunPace::set_speed(double speed) {
  // Time gained without a speed limit is not waited for.
  if (speed_ == 0) allowed_ = reached_;
  speed_ = speed;
  behind_ = 0, rate_ = speed;
}

double RunPace::next(double passed, double reached) {
  constexpr double pause = 0.25, lead = 0.1, memory = 0.5;  // s of the clock
  passed = std::clamp(passed, 0.0, pause);
  const double went = reached - reached_;
  reached_ = reached;
  if (speed_ == 0) return std::numeric_limits<double>::infinity();
  // Never less than two steps ahead, or it could not take the next one.
  const double farthest = reached + std::max(lead * speed_, 2 * step_);
  const double desired = allowed_ + passed * speed_;
  allowed_ = std::min(desired, farthest);
  if (passed > 0) rate_ += (1 - std::exp(-passed / memory)) * (went / passed - rate_);
  behind_ = desired > farthest ? behind_ + passed : 0;
  return allowed_;
}

std::optional<double> RunPace::slowness() const {
  constexpr double long_enough = 0.5;  // s of the clock
  if (speed_ == 0 || behind_ < long_enough) return std::nullopt;
  return std::max(rate_, 0.0);
}

}  // namespace flexura
