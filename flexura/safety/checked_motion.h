#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "flexura/safety/contact_watch.h"
#include "flexura/safety/limits.h"
#include "flexura/safety/motion_check.h"
#include "flexura/safety/worst.h"

namespace flexura {

/// A motion to check, and the report that receives the violations. The referenced objects must outlive this
/// object.
struct CheckedMotion {
  const Arm& arm;
  const std::vector<ContactWatch>& contacts;
  const TimedMotion& timed;
  double step = 0;  ///< Step of the clock, s.
  SafetyReport& report;
  /// Function that is called with the completed fraction of this motion's check. The function returns false
  /// to stop the check.
  std::function<bool(double done)> go_on;
  /// Whether the motion is an elastic arm's shape. If so, jumps of the command are checked separately, and
  /// not in the shape.
  bool is_shape = false;

  [[nodiscard]] const Motion& motion() const { return *timed.motion; }
  [[nodiscard]] Span whole() const { return {0, motion().duration()}; }
  [[nodiscard]] std::size_t last_step() const {
    return static_cast<std::size_t>(std::ceil(motion().duration() / step));
  }
  /// Returns the times at which the motion is sampled, s since the motion's start: the start, all clock steps
  /// within the motion, and the end. The first and the last interval may be shorter than a step.
  [[nodiscard]] std::vector<double> clock_times() const {
    constexpr double part = 1e-9;  // Fraction of a step; times closer than this count as equal.
    const double duration = motion().duration();
    std::vector<double> times = {0};
    for (double k = std::floor(timed.start / step + part) + 1;; ++k) {
      const double time = k * step - timed.start;
      if (time > duration - part * step) break;
      times.push_back(time);
    }
    if (duration > 0) times.push_back(duration);
    return times;
  }

  /// Adds a violation to the report. `span` and `worst.time` count from the motion's start, s.
  void add(Violation violation, const Span& span, const WorstValue& worst, double sign = 1) const {
    violation.start = timed.start + span.start;
    violation.end = timed.start + span.end;
    violation.worst_time = timed.start + worst.time;
    violation.value = sign * worst.value;
    report.violations.push_back(std::move(violation));
  }
  void add_jump(const Span& span, std::size_t section, bool is_of_stretch, const WorstValue& size) const {
    add({.hazard = Hazard::jump, .section = section, .name = timed.name, .is_of_stretch = is_of_stretch},
        span, size);
  }
  /// Adds a violation for a state that is impossible at `time`, s: a value is not finite, or a length is not
  /// above 0.
  void add_impossible(double time) const {
    add({.hazard = Hazard::not_finite, .section = impossible_section(motion().at(time)), .name = timed.name},
        {time, time}, {time, 0});
  }
};

/// Returns the rate above which a rate limit counts as violated.
[[nodiscard]] inline double threshold_of_rate(double limit) { return limit * (1 + limit_tolerance); }

/// Returns the violation for a contact. The times and the depth of the violation are not set.
[[nodiscard]] inline Violation contact_violation(const ContactWatch& watch, const Contact& place) {
  return {.hazard = watch.hazard(),
          .section = place.section,
          .other_section = place.other_section,
          .name = watch.obstacle_name()};
}

/// Checks a motion with known bounds on its rates, which must start in a possible state (docs/safety.md).
void check_bounded(const CheckedMotion& checked);

/// Checks a motion at every clock step. The motion's rates may be unknown.
void check_sampled(const CheckedMotion& checked);

}  // namespace flexura
