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

/// A motion under check and the report for its findings. The referenced objects must outlive it.
struct CheckedMotion {
  const Arm& arm;
  const std::vector<ContactWatch>& contacts;
  const TimedMotion& timed;
  double step = 0;  ///< Clock step, s.
  SafetyReport& report;
  /// Receives the completed share of this motion's check; returns false to end the check.
  std::function<bool(double done)> go_on;

  [[nodiscard]] const Motion& motion() const { return *timed.motion; }
  [[nodiscard]] Span whole() const { return {0, motion().duration()}; }
  [[nodiscard]] std::size_t last_step() const {
    return static_cast<std::size_t>(std::ceil(motion().duration() / step));
  }
  /// Returns the times of the clock at which the motion is sampled, in the motion's time: its start, all
  /// clock steps within it, and its end. The first interval may be shorter than a step.
  [[nodiscard]] std::vector<double> clock_times() const {
    constexpr double part = 1e-9;  // Share of a step: closer times count as one.
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

  /// Adds a violation. Its span and worst time are in the motion's time.
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
  /// Adds a violation: the law has no value, or no length, at `time`.
  void add_impossible(double time) const {
    add({.hazard = Hazard::not_finite, .section = impossible_section(motion().at(time)), .name = timed.name},
        {time, time}, {time, 0});
  }
};

/// Returns the threshold of a bend rate for this limit.
[[nodiscard]] inline double threshold_of_rate(double limit) { return limit * (1 + limit_tolerance); }

/// Returns a contact's violation without times and depth.
[[nodiscard]] inline Violation contact_violation(const ContactWatch& watch, const Contact& place) {
  return {.hazard = watch.hazard(),
          .section = place.section,
          .other_section = place.other_section,
          .name = watch.obstacle_name()};
}

/// Checks a law with known rates, from a possible state at its start (docs/safety.md).
void check_bounded(const CheckedMotion& checked);

/// Checks any law at every clock step.
void check_sampled(const CheckedMotion& checked);

}  // namespace flexura
