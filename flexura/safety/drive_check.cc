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

// Doubles count exactly up to here; no motor goes farther.
constexpr double max_countable = 9007199254740992.0;

// One limit of one axis; joins what is too much in rows that follow each other.
class AxisLimit {
 public:
  AxisLimit(Hazard hazard, const Drive& drive, std::size_t axis, double limit)
      : found_{.hazard = hazard,
               .section = drive.tendons[axis].section,
               .name = drive.axis_name(axis),
               .limit = limit} {}

  void add(Span span, double value, SafetyReport& report) {
    if (value <= found_.limit * (1 + limit_tolerance)) {
      close(report);
      return;
    }
    if (!std::exchange(is_open_, true)) found_.start = span.start, found_.value = 0;
    found_.end = span.end;
    if (value > found_.value) found_.value = value, found_.worst_time = span.end;
  }
  void close(SafetyReport& report) {
    if (std::exchange(is_open_, false)) report.violations.push_back(found_);
  }

 private:
  Violation found_;
  bool is_open_ = false;
};

// Follows one axis from row to row.
class AxisCheck {
 public:
  AxisCheck(const Drive& drive, std::size_t axis)
      : to_radians_(2 * std::numbers::pi / drive.axes[axis].motor.resolution()),
        speed_(Hazard::motor_speed, drive, axis, drive.axes[axis].motor.max_speed),
        step_rate_(Hazard::step_rate, drive, axis, drive.axes[axis].motor.max_step_rate),
        acceleration_(Hazard::motor_acceleration, drive, axis, drive.axes[axis].motor.max_acceleration),
        position_(Hazard::motor_position, drive, axis, drive.axes[axis].motor.max_position) {}

  void start(double time, double position, SafetyReport& report) {
    last_position_ = position;
    position_.add({time, time}, std::abs(position), report);
  }
  // `last` and `now` are the steps before and up to this row; the first step comes after one of standing.
  void row(Span last, Span now, double position, SafetyReport& report) {
    const double rate = (position - last_position_) / (now.end - now.start);
    step_rate_.add(now, std::abs(rate), report);
    speed_.add(now, std::abs(rate) * to_radians_, report);
    change_rate(last, now, rate, report);
    position_.add({now.end, now.end}, std::abs(position), report);
    last_position_ = position;
  }
  // The motor stands after the last step.
  void stop(Span last, SafetyReport& report) {
    change_rate(last, {last.end, 2 * last.end - last.start}, 0, report);
    for (AxisLimit* limit : {&speed_, &step_rate_, &acceleration_, &position_}) limit->close(report);
  }

 private:
  void change_rate(Span last, Span now, double rate, SafetyReport& report) {
    const double time = (now.end - last.start) / 2;
    const double acceleration = std::abs(rate - last_rate_) * to_radians_ / time;
    acceleration_.add({now.start, now.start}, acceleration, report);
    last_rate_ = rate;
  }

  double to_radians_;  // a microstep of the motor
  AxisLimit speed_, step_rate_, acceleration_, position_;
  double last_position_ = 0;  // microsteps
  double last_rate_ = 0;      // microsteps/s
};

// The displacements in a state, if motors can be sent there.
std::optional<TendonDisplacements> displacements_in(const Arm& arm, const Drive& drive,
                                                    const ArmState& state) {
  if (!is_possible(state)) return std::nullopt;
  TendonDisplacements wanted = tendon_displacements(arm, drive, state);
  for (std::size_t i = 0; i < drive.axes.size(); ++i) {
    const double farthest = std::abs(wanted.pulled[i]) * drive.axes[i].microsteps_a_metre();
    if (!(farthest + drive.axes[i].play() < max_countable)) return std::nullopt;
  }
  return wanted;
}

bool is_acceleration(const Violation& violation) { return violation.hazard == Hazard::motor_acceleration; }

bool has_speed_limit(const Axis& axis) { return std::isfinite(axis.max_cable_speed()); }

// Halves an interval until the rates in it prove that no tendon is too fast for its axis, or it is short.
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

// The axes with a limit on speed that the law may break somewhere, as far as its rates tell.
std::vector<char> unproven_axes(const Arm& arm, const Drive& drive, const Span& span,
                                const RateBounds& rates) {
  constexpr double shortest_part = 1.0 / 16384;
  std::vector<char> is_unproven(drive.axes.size(), 0);
  if (!std::ranges::any_of(drive.axes, has_speed_limit)) return is_unproven;
  prove(arm, drive, span, shortest_part * (span.end - span.start), rates, is_unproven);
  return is_unproven;
}

// What the rows break is told already.
void say_sampled(std::vector<char> is_unproven, const Drive& drive, std::size_t found_before, double step,
                 SafetyReport& report) {
  for (std::size_t k = found_before; k < report.violations.size(); ++k) {
    const Violation& found = report.violations[k];
    if (found.hazard != Hazard::motor_speed && found.hazard != Hazard::step_rate) continue;
    for (std::size_t i = 0; i < is_unproven.size(); ++i) {
      if (drive.axis_name(i) == found.name) is_unproven[i] = 0;
    }
  }
  std::string names;
  for (std::size_t i = 0; i < is_unproven.size(); ++i) {
    if (is_unproven[i] != 0) names += (names.empty() ? "" : ", ") + drive.axis_name(i);
  }
  if (names.empty()) return;
  report.caveats.push_back(fmt::format(
      "motor speed and step rate of {}: sampled every {:.6g} s; the law may be faster between two steps",
      names, step));
}

}  // namespace

void check_drive(const Arm& arm, const Drive& drive, const std::function<ArmState(double time)>& state_at,
                 std::span<const double> times, const RateBounds& rates, SafetyReport& report) {
  if (times.size() < 2) return;
  const std::size_t found_before = report.violations.size();
  const auto first = displacements_in(arm, drive, state_at(times[0]));
  if (!first) return;
  MotorCommander commander(drive, *first);
  std::vector<AxisCheck> axes;
  for (std::size_t i = 0; i < drive.axes.size(); ++i) {
    axes.emplace_back(drive, i);
    axes.back().start(times[0], commander.targets()[i], report);
  }
  Span last{2 * times[0] - times[1], times[0]};
  for (std::size_t k = 1; k < times.size(); ++k) {
    const auto wanted = displacements_in(arm, drive, state_at(times[k]));
    if (!wanted) break;
    commander.follow(*wanted);
    const Span now{times[k - 1], times[k]};
    for (std::size_t i = 0; i < axes.size(); ++i) axes[i].row(last, now, commander.targets()[i], report);
    last = now;
  }
  for (AxisCheck& axis : axes) axis.stop(last, report);
  say_sampled(unproven_axes(arm, drive, {times.front(), last.end}, rates), drive, found_before,
              times[1] - times[0], report);
  if (!std::ranges::any_of(report.violations, is_acceleration)) return;
  report.caveats.push_back(fmt::format(
      "motor acceleration: from one step of the clock to the next, {:.6g} s; of a law that starts "
      "or turns at once the value goes with that step",
      times[1] - times[0]));
}

}  // namespace flexura
