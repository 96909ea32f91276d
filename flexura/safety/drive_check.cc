#include "flexura/safety/drive_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "flexura/kinematics/motors.h"
#include "flexura/kinematics/tendons.h"
#include "flexura/safety/limits.h"
#include "flexura/safety/motion_check.h"
#include "flexura/safety/spans.h"

namespace flexura {
namespace {

// Doubles represent all integers up to this value; motor positions must not exceed it.
constexpr double max_countable = 9007199254740992.0;

// Checks one limit of one axis. Joins violations in consecutive rows.
class AxisLimit {
 public:
  AxisLimit(Hazard hazard, const Drive& drive, std::size_t axis, double limit)
      : found_{.hazard = hazard,
               .section = drive.tendons[axis].section,
               .name = drive.axis_name(axis),
               .limit = limit} {}

  [[nodiscard]] bool is_beyond(double value) const { return value > found_.limit * (1 + limit_tolerance); }
  // Returns whether the limit is violated.
  bool add(Span span, double value, SafetyReport& report) {
    if (!is_beyond(value)) {
      close(report);
      return false;
    }
    if (!std::exchange(is_open_, true)) found_.start = span.start, found_.value = 0;
    found_.end = span.end;
    if (value > found_.value) found_.value = value, found_.worst_time = span.end;
    return true;
  }
  void close(SafetyReport& report) {
    if (std::exchange(is_open_, false)) report.violations.push_back(found_);
  }

 private:
  Violation found_;
  bool is_open_ = false;
};

// A motor's position in a row, microsteps: commanded, and before rounding with and without backlash and
// friction.
struct MotorPlace {
  double position = 0;
  double target = 0;
  double without_backlash = 0;
  double taken_up = 0;  // Part of the motion since the last row.
};

// Facts for the caveats of an axis, in addition to its violations.
struct AxisNotes {
  bool has_single_steps = false;       // Rows of one microstep were accepted.
  bool is_rounded_over = false;        // Only the rounding violates a limit.
  bool takes_up_backlash = false;      // The backlash compensation is too fast or too sudden.
  bool is_over_while_steered = false;  // Only backlash or rounding violates a limit while the arm is servoed.
};

// Checks one axis from row to row.
class AxisCheck {
 public:
  AxisCheck(const Drive& drive, std::size_t axis)
      : to_radians_(2 * std::numbers::pi / drive.axes[axis].motor.resolution()),
        most_(std::min(drive.axes[axis].motor.max_step_rate, drive.axes[axis].motor.max_speed / to_radians_) *
              (1 + limit_tolerance)),
        speed_(Hazard::motor_speed, drive, axis, drive.axes[axis].motor.max_speed),
        step_rate_(Hazard::step_rate, drive, axis, drive.axes[axis].motor.max_step_rate),
        acceleration_(Hazard::motor_acceleration, drive, axis, drive.axes[axis].motor.max_acceleration),
        position_(Hazard::motor_position, drive, axis, drive.axes[axis].motor.max_position) {}

  [[nodiscard]] const AxisNotes& notes() const { return notes_; }

  void start(double time, const MotorPlace& place, SafetyReport& report) {
    last_ = place;
    position_.add({time, time}, std::abs(place.position), report);
  }
  // `last` and `now` are the steps before and up to this row; before the first step the motor rests.
  void row(Span last, Span now, const MotorPlace& place, const SteeredSpan* steered, SafetyReport& report) {
    if (steered != nullptr) {
      steered_row(last, now, place, steered->is_planned, report);
      return;
    }
    const double time = now.end - now.start;
    const double desired = (place.target - last_.target) / time;
    const bool took_up = place.taken_up > 1e-3;  // Smaller changes are rounding.
    const double rate = judged_rate(place.position - last_.position, desired, time);
    const bool is_frequent = step_rate_.add(now, std::abs(rate), report);
    const bool is_fast = speed_.add(now, std::abs(rate) * to_radians_, report) || is_frequent;
    const bool is_sudden = change_rate(now.start, (now.end - last.start) / 2, desired, report);
    last_desired_ = desired;
    if (is_fast && std::abs(desired) <= most_) notes_.is_rounded_over = true;
    if ((is_fast && took_up) || (is_sudden && (took_up || took_up_))) notes_.takes_up_backlash = true;
    position_.add({now.end, now.end}, std::abs(place.position), report);
    last_ = place;
    took_up_ = took_up;
  }
  // The motor rests after the last step, which is shorter if the run is no multiple of `step`. It has at
  // least a whole step to stop.
  void stop(Span last, double step, SafetyReport& report) {
    const bool is_sudden = change_rate(last.end, std::max(last.end - last.start, step), 0, report);
    if (is_sudden && took_up_) notes_.takes_up_backlash = true;
    for (AxisLimit* limit : {&speed_, &step_rate_, &acceleration_, &position_}) limit->close(report);
  }

 private:
  void steered_row(Span last, Span now, const MotorPlace& place, bool is_planned, SafetyReport& report) {
    const double time = now.end - now.start, turning = (now.end - last.start) / 2;
    const double rate = (place.without_backlash - last_.without_backlash) / time,
                 desired = (place.target - last_.target) / time;
    if (is_planned) {
      const bool is_fast = step_rate_.add(now, std::abs(rate), report) ||
                           speed_.add(now, std::abs(rate) * to_radians_, report);
      const bool is_sudden = change_rate(now.start, turning, rate, report);
      const bool is_list_fast = std::abs(place.position - last_.position) / time > most_,
                 is_list_sudden =
                     acceleration_.is_beyond(std::abs(desired - last_desired_) * to_radians_ / turning);
      if ((is_list_fast && !is_fast) || (is_list_sudden && !is_sudden)) notes_.is_over_while_steered = true;
      last_desired_ = desired;
    } else {
      // The rate is unknown, but the motion starts and ends at rest.
      last_rate_ = last_desired_ = 0;
      for (AxisLimit* limit : {&speed_, &step_rate_, &acceleration_}) limit->close(report);
    }
    position_.add({now.end, now.end}, std::abs(place.position), report);
    last_ = place;
    took_up_ = false;
  }
  // Returns the rate of a row, microsteps/s. A motor cannot move by less than one microstep. If that is too
  // fast in a short row, the rate before rounding counts.
  double judged_rate(double moved, double desired, double time) {
    if (std::abs(moved) > 1 || 1 / time <= most_) return moved / time;
    if (moved != 0) notes_.has_single_steps = true;
    return desired;
  }
  bool change_rate(double start, double time, double rate, SafetyReport& report) {
    const double acceleration = std::abs(rate - last_rate_) * to_radians_ / time;
    last_rate_ = rate;
    return acceleration_.add({start, start}, acceleration, report);
  }

  double to_radians_;  // Radians per microstep of the motor.
  double most_;        // Lower of both limits, microsteps/s.
  AxisLimit speed_, step_rate_, acceleration_, position_;
  MotorPlace last_;
  double last_rate_ = 0, last_desired_ = 0;  // microsteps/s, before rounding; `last_desired_` with backlash.
  bool took_up_ = false;                     // The motor moved through the backlash in the last row.
  AxisNotes notes_;
};

// Returns the displacements in a state if the motors can reach them.
std::optional<TendonDisplacements> displacements_in(const Arm& arm, const Drive& drive,
                                                    const ArmState& state) {
  if (!is_possible(state)) return std::nullopt;
  TendonDisplacements desired = tendon_displacements(arm, drive, state);
  for (std::size_t i = 0; i < drive.axes.size(); ++i) {
    const double farthest = std::abs(desired.pulled[i]) * drive.axes[i].microsteps_a_metre();
    const double friction = desired.wraps.empty() ? 0 : drive.axes[i].friction_steps(desired.wraps[i]);
    if (!(farthest + drive.axes[i].backlash_steps() + friction < max_countable)) return std::nullopt;
  }
  return desired;
}

std::vector<MotorPlace> places_of(const MotorCommander& commander, const Drive& drive,
                                  const TendonDisplacements& desired) {
  const std::vector<double> exact = motor_positions(drive, desired);
  std::vector<MotorPlace> places;
  places.reserve(exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i)
    places.push_back({static_cast<double>(commander.positions()[i]), commander.targets()[i], exact[i],
                      commander.taken_up()[i]});
  return places;
}

bool is_acceleration(const Violation& violation) { return violation.hazard == Hazard::motor_acceleration; }

bool has_speed_limit(const Axis& axis) { return std::isfinite(axis.max_cable_speed()); }

// Halves an interval until the rates in it prove that no tendon is too fast for its axis, or it is too short.
void prove(const Arm& arm, const Drive& drive, Span span, double shortest, const RateBounds& rates,
           std::vector<char>& is_unproven) {
  const auto known = rates(span.start, span.end);
  std::vector<double> speeds;
  if (known) speeds = tendon_speed_bounds(arm, drive, *known);
  const auto is_open = [&](std::size_t i) {
    if (is_unproven[i] != 0 || !has_speed_limit(drive.axes[i])) return false;
    return !known || !(speeds[i] <= drive.axes[i].max_cable_speed() * (1 + limit_tolerance));
  };
  bool any = false;
  for (std::size_t i = 0; i < drive.axes.size(); ++i) any = any || is_open(i);
  if (!any) return;
  if (!known || span.end - span.start <= shortest) {
    for (std::size_t i = 0; i < drive.axes.size(); ++i) {
      if (is_open(i)) is_unproven[i] = 1;
    }
    return;
  }
  const double middle = (span.start + span.end) / 2;
  prove(arm, drive, {span.start, middle}, shortest, rates, is_unproven);
  prove(arm, drive, {middle, span.end}, shortest, rates, is_unproven);
}

// Returns the axes with a speed limit that the motion may exceed between rows according to its rates.
std::vector<char> unproven_axes(const Arm& arm, const Drive& drive, const Span& span,
                                const RateBounds& rates) {
  constexpr double shortest_part = 1.0 / 16384;
  std::vector<char> is_unproven(drive.axes.size(), 0);
  if (!std::ranges::any_of(drive.axes, has_speed_limit)) return is_unproven;
  prove(arm, drive, span, shortest_part * (span.end - span.start), rates, is_unproven);
  return is_unproven;
}

std::string names_of(const std::vector<char>& is_meant, const Drive& drive) {
  std::string names;
  for (std::size_t i = 0; i < is_meant.size(); ++i) {
    if (is_meant[i] != 0) names += (names.empty() ? "" : ", ") + drive.axis_name(i);
  }
  return names;
}

// Omits axes for which the rows have violations.
void report_sampled(std::vector<char> is_unproven, const Drive& drive, std::size_t found_before, double step,
                    SafetyReport& report) {
  for (std::size_t k = found_before; k < report.violations.size(); ++k) {
    const Violation& found = report.violations[k];
    if (found.hazard != Hazard::motor_speed && found.hazard != Hazard::step_rate) continue;
    for (std::size_t i = 0; i < is_unproven.size(); ++i) {
      if (drive.axis_name(i) == found.name) is_unproven[i] = 0;
    }
  }
  const std::string names = names_of(is_unproven, drive);
  if (names.empty()) return;
  report.caveats.push_back(fmt::format(
      "motor speed and step rate of {}: sampled every {:.6g} s; the motion may be faster between two samples",
      names, step));
}

void report_notes(const std::vector<AxisCheck>& axes, const Drive& drive, double step, SafetyReport& report) {
  const auto say = [&](bool AxisNotes::* note, const std::string& what) {
    std::vector<char> is_meant;
    is_meant.reserve(axes.size());
    for (const AxisCheck& axis : axes) is_meant.push_back(axis.notes().*note ? 1 : 0);
    const std::string names = names_of(is_meant, drive);
    if (!names.empty()) report.caveats.push_back(fmt::format(fmt::runtime(what), names, step));
  };
  say(&AxisNotes::has_single_steps,
      "motor speed and step rate of {}: a single microstep in a clock step of {:.6g} s already exceeds the "
      "limit. The motion is accepted if it is within the limit before rounding");
  say(&AxisNotes::is_rounded_over,
      "motor speed and step rate of {}: the motion is within the limit, but exceeds it after rounding, by up "
      "to one microstep in {:.6g} s");
  say(&AxisNotes::takes_up_backlash,
      "motors of {}: when a tendon reverses, its backlash is compensated within one clock step, {:.6g} s; a "
      "shorter step requires a higher speed and acceleration");
  say(&AxisNotes::is_over_while_steered,
      "motors of {}: during a servo, speeds and accelerations are checked without backlash and rounding, as "
      "in the limiter. With backlash and rounding, the commands exceed a limit within one clock step, "
      "{:.6g} s");
}

}  // namespace

void check_drive(const Arm& arm, const Drive& drive, const std::function<ArmState(double time)>& state_at,
                 std::span<const double> times, const RateBounds& rates, SafetyReport& report,
                 std::span<const SteeredSpan> steered) {
  if (times.size() < 2) return;
  const std::size_t found_before = report.violations.size();
  const auto first = displacements_in(arm, drive, state_at(times[0]));
  if (!first) return;
  MotorCommander commander(drive, *first);
  std::vector<MotorPlace> places = places_of(commander, drive, *first);
  std::vector<AxisCheck> axes;
  for (std::size_t i = 0; i < drive.axes.size(); ++i) {
    axes.emplace_back(drive, i);
    axes.back().start(times[0], places[i], report);
  }
  Span last{2 * times[0] - times[1], times[0]};
  for (std::size_t k = 1; k < times.size(); ++k) {
    const auto desired = displacements_in(arm, drive, state_at(times[k]));
    if (!desired) break;
    commander.follow(*desired);
    const Span now{times[k - 1], times[k]};
    places = places_of(commander, drive, *desired);
    while (!steered.empty() && steered.front().end <= now.start) steered = steered.subspan(1);
    const SteeredSpan* span =
        !steered.empty() && steered.front().start < now.end ? &steered.front() : nullptr;
    for (std::size_t i = 0; i < axes.size(); ++i) axes[i].row(last, now, places[i], span, report);
    last = now;
  }
  const double step = times[1] - times[0];
  for (AxisCheck& axis : axes) axis.stop(last, step, report);
  report_sampled(unproven_axes(arm, drive, {times.front(), last.end}, rates), drive, found_before, step,
                 report);
  report_notes(axes, drive, step, report);
  if (!std::ranges::any_of(report.violations, is_acceleration)) return;
  report.caveats.push_back(
      fmt::format("motor acceleration: computed from one clock step to the next, {:.6g} s; for a motion that "
                  "starts or reverses instantly, the value depends on this step",
                  step));
}

}  // namespace flexura
