#include "flexura/kinematics/profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace flexura {

Profile::Profile(Kind kind, double duration, double ramp) : kind_(kind), duration_(duration), ramp_(ramp) {
  if (!(duration > 0) || !std::isfinite(duration)) {
    throw std::invalid_argument(fmt::format("a motion cannot have a duration of {} s", duration));
  }
}

Profile Profile::linear(double duration) { return {Kind::linear, duration, 0}; }

Profile Profile::minimum_jerk(double duration) { return {Kind::minimum_jerk, duration, 0}; }

Profile Profile::trapezoid(double distance, double max_rate, double max_acceleration) {
  if (!(distance > 0) || !(max_rate > 0) || !(max_acceleration > 0)) {
    throw std::invalid_argument(
        fmt::format("a trapezoid needs a distance, a rate and an acceleration above 0, not {}, {}, {}",
                    distance, max_rate, max_acceleration));
  }
  // Over a short distance the rate is not reached: half of the distance accelerating, half decelerating.
  const double ramp = std::min(max_rate / max_acceleration, std::sqrt(distance / max_acceleration));
  const double even_rate = ramp * max_acceleration;
  return {Kind::trapezoid, distance / even_rate + ramp, ramp};
}

double Profile::fraction(double time) const {
  if (time <= 0) return 0;
  if (time >= duration_) return 1;
  // The second half mirrors the first, so that both ends are exact.
  if (time > duration_ / 2) return 1 - fraction(duration_ - time);
  const double x = time / duration_;
  switch (kind_) {
    case Kind::linear:
      return x;
    case Kind::minimum_jerk:
      return x * x * x * (10 + x * (6 * x - 15));
    case Kind::trapezoid:
      break;
  }
  const double even_rate = 1 / (duration_ - ramp_);
  return time < ramp_ ? even_rate * time * time / (2 * ramp_) : even_rate * (time - ramp_ / 2);
}

double Profile::rate(double time) const {
  if (time < 0 || time > duration_) return 0;
  const double x = std::min(time, duration_ - time) / duration_;
  switch (kind_) {
    case Kind::linear:
      return 1 / duration_;
    case Kind::minimum_jerk:
      return 30 * x * x * (1 - x) * (1 - x) / duration_;
    case Kind::trapezoid:
      break;
  }
  return std::min(1.0, x * duration_ / ramp_) / (duration_ - ramp_);
}

double Profile::max_rate(double start, double end) const {
  return rate(std::clamp(duration_ / 2, std::min(start, end), std::max(start, end)));
}

double Profile::min_rate(double start, double end) const { return std::min(rate(start), rate(end)); }

}  // namespace flexura
