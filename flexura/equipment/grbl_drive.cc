#include "flexura/equipment/grbl_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "flexura/base/table.h"

namespace flexura {
namespace {

constexpr int soft_limit_alarm = 2;  // The only alarm that does not lose the position.
constexpr int report_tries = 5;
constexpr double off_line = 2;         // Steps by which an axis may be off a straight line.
constexpr double start_time = 0.05;    // s; a motion has begun by then.
constexpr double report_period = 0.2;  // s; while moving, a command asks for a report after this time.
// Grbl counts in 32-bit floating-point mm, so positions beyond this would be rounded.
constexpr double most_steps = 2097152;

std::size_t window_of(const GrblConfig& config) {
  return static_cast<std::size_t>(std::clamp<std::int64_t>(config.window, grbl::longest_line, 4096));
}

std::string positions_text(std::span<const std::int64_t> steps) {
  std::string list;
  for (const std::int64_t one : steps) list += fmt::format("{}{}", list.empty() ? "" : ", ", one);
  return list;
}

}  // namespace

GrblDrive::GrblDrive(std::unique_ptr<Link> link, const ClockPort& clock, GrblConfig config)
    : link_(std::move(link)),
      clock_(clock),
      config_(std::move(config)),
      session_(*link_, clock_, window_of(config_), config_.answer_timeout),
      path_(GrblAxes{}) {
  std::size_t next = 0;
  for (const char letter : config_.axes) {
    const std::size_t at =
        next <= grbl::axis_letters.size() ? grbl::axis_letters.find(letter, next) : std::string_view::npos;
    if (at == std::string_view::npos)
      throw std::invalid_argument("the axes of a Grbl controller are letters in the order X Y Z A B C U V");
    indices_.push_back(at);
    next = at + 1;
  }
  if (indices_.empty()) throw std::invalid_argument("a drive needs at least one axis");
  if (!(config_.answer_timeout > 0) || !(config_.connect_timeout > 0) || !(config_.stop_timeout > 0) ||
      !(config_.homing_timeout > 0) || !(config_.lead >= 0) || !(config_.most_lag >= config_.lead))
    throw std::invalid_argument("the times of a Grbl controller must be above 0, and most_lag at least lead");
  zero_.assign(axes(), 0);
}

PortFault GrblDrive::refuse(std::string_view what) const {
  return {FaultKind::refused, fmt::format("{}: {}", link_->name(), what)};
}

void GrblDrive::lose_position(std::string reason) {
  if (is_known_) why_unknown_ = std::move(reason);
  is_known_ = false;
}

PortFault GrblDrive::unknown_position() const {
  return refuse(fmt::format("the position is unknown{}: home the controller or set its position",
                            why_unknown_.empty() ? "" : " (" + why_unknown_ + ")"));
}

double GrblDrive::setting(int number) const {
  const auto found = std::ranges::find(settings_, number, &std::pair<int, double>::first);
  return found == settings_.end() ? 0 : found->second;
}

bool GrblDrive::knows_position() const {
  const std::scoped_lock lock(mutex_);
  return is_known_;
}

// Looks at what the controller has said unasked.
CommandOutcome GrblDrive::check_usable() {
  if (!is_connected_) return refuse("not connected");
  auto drained = session_.drain();
  if (!drained) return drained;
  if (session_.take_restart()) lose_position("the controller has restarted");
  if (const auto alarm = session_.take_alarm()) alarm_ = alarm;
  if (alarm_) {
    if (*alarm_ != soft_limit_alarm) lose_position("after an alarm");
    return refuse(fmt::format("the controller is in alarm{}: clear its cause and unlock it{}",
                              *alarm_ == unknown_alarm
                                  ? std::string()
                                  : fmt::format(" {} ({})", *alarm_, grbl_alarm_meaning(*alarm_)),
                              is_known_ ? "" : ", then home it or set its position"));
  }
  return Accepted{};
}

CommandOutcome GrblDrive::check_state(GrblState state) {
  if (state == GrblState::idle || state == GrblState::jog) return Accepted{};
  if (state == GrblState::alarm) {
    alarm_ = session_.take_alarm().value_or(alarm_.value_or(unknown_alarm));
    return check_usable();
  }
  return refuse(
      fmt::format("the controller is in the state {}: {}", text(state),
                  state == GrblState::door ? "close its safety door, then unlock it" : "unlock it"));
}

std::optional<std::vector<std::int64_t>> GrblDrive::steps_of(const GrblStatus& status) const {
  if (status.is_work || status.positions.size() != reported_axes_) return std::nullopt;
  std::vector<std::int64_t> steps;
  for (std::size_t i = 0; i < axes(); ++i) {
    const double exact = status.positions[indices_[i]] * can_.per_mm[i];
    const double whole = std::round(exact);
    // Positions have 3 decimals. A number that is not a whole step was damaged on its way.
    const double tolerance = 0.00055 * can_.per_mm[i] + 1.2e-7 * std::abs(exact);
    if (!(std::abs(whole) <= 2 * most_steps) || std::abs(exact - whole) > tolerance) return std::nullopt;
    steps.push_back(static_cast<std::int64_t>(whole));
  }
  return steps;
}

Outcome<GrblDrive::Report> GrblDrive::report() {
  for (int i = 0; i < report_tries; ++i) {
    const double asked = clock_.now();
    const auto status = session_.status();
    if (!status) return *status.fault();
    if (const auto steps = steps_of(status.value())) {
      checked_at_ = asked;
      return Report{status.value().state, *steps, asked, clock_.now()};
    }
  }
  return refuse(
      "the controller's status reports have no machine positions of whole steps: check settings $10 "
      "and $13 and the cable");
}

Outcome<GrblDrive::Report> GrblDrive::checked_report() {
  std::optional<std::vector<std::int64_t>> resting;
  for (int i = 0; i < report_tries; ++i) {
    auto asked = report();
    if (!asked) return asked;
    const Report& now = asked.value();
    const auto usable = check_state(now.state);
    if (!usable) return *usable.fault();
    if (now.state == GrblState::idle && now.steps == path_.end()) {
      path_.rest(now.steps, now.asked);
      return asked;
    }
    if (now.state == GrblState::jog && path_.can_be_at(now.steps, off_line, now.received)) {
      path_.report(now.steps, now.asked, now.received);
      return asked;
    }
    if (now.state == GrblState::idle && now.asked < accepted_at_ + start_time) {
      // It may not have begun yet.
      const auto heard = session_.listen(start_time);
      if (!heard) return *heard.fault();
      continue;
    }
    // Two equal reports of a rest are believed.
    if (now.state == GrblState::idle && resting == now.steps) {
      const std::string places = fmt::format(
          "the motors were commanded to {} but stand at {} (steps of the "
          "controller)",
          positions_text(path_.end()), positions_text(now.steps));
      // Elsewhere, the controller may count from another zero after a restart that was not heard of.
      if (!path_.can_be_at(now.steps, off_line, now.received)) lose_position(places);
      path_.rest(now.steps, now.asked);
      if (!is_known_) return refuse(places + ": the position is lost, home it or set its position");
      return refuse(places + ": the controller has not executed the motion");
    }
    resting = now.state == GrblState::idle ? std::optional(now.steps) : std::nullopt;
  }
  const auto stopped = stop_and_locate(true);
  if (!stopped) return *stopped.fault();
  return refuse("the motors were not on the commanded path; they have been stopped");
}

CommandOutcome GrblDrive::brake() {
  for (const double end = clock_.now() + config_.stop_timeout; clock_.now() < end;) {
    auto canceled = session_.act(grbl::cancel_jog);
    if (!canceled) return canceled;
    const auto status = session_.status(true);
    if (!status) return *status.fault();
    if (status.value().state != GrblState::jog) break;
  }
  // A line that was on its way may begin to move after the cancel.
  if (session_.is_out_of_step()) {
    const auto answered = session_.resynchronize();
    if (!answered) return answered;
  }
  return stop_and_locate();
}

CommandOutcome GrblDrive::stop_and_locate(bool is_anywhere) {
  const double end = clock_.now() + config_.stop_timeout;
  std::optional<std::vector<std::int64_t>> resting;
  while (clock_.now() < end) {
    const auto asked = report();
    if (!asked) return *asked.fault();
    const Report& now = asked.value();
    if (now.state != GrblState::jog) {
      auto usable = check_state(now.state);
      if (!usable) return usable;
      if (resting == now.steps) {
        if (!is_anywhere && !path_.can_be_at(now.steps, off_line, now.received))
          lose_position(
              fmt::format("the motors stopped at {} (steps of the controller), which is not on the "
                          "commanded path to {}",
                          positions_text(now.steps), positions_text(path_.end())));
        path_.stop(now.steps, now.asked);
        return Accepted{};
      }
      resting = now.steps;
      continue;
    }
    resting.reset();
    const auto canceled = session_.act(grbl::cancel_jog);
    if (!canceled) return canceled;
  }
  lose_position("the controller has been reset, because the motors did not stop");
  (void)session_.act(grbl::hold);
  (void)session_.act(grbl::reset);
  return refuse(
      fmt::format("the motors have not stopped within {:g} s; the controller has been reset: home it "
                  "or set its position",
                  config_.stop_timeout));
}

std::vector<std::int64_t> GrblDrive::clamped(std::span<const double> targets) const {
  const double travel = config_.travel ? static_cast<double>(*config_.travel) : most_steps;
  std::vector<std::int64_t> steps;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    const auto zero = static_cast<double>(zero_[i]);
    double target = std::round(std::clamp(targets[i], -travel, travel)) + zero;
    double low = -most_steps, high = most_steps;
    if (setting(20) != 0) {
      const auto axis = static_cast<int>(indices_[i]);
      const double length = std::floor(setting(130 + axis) * can_.per_mm[i] + 1e-6);
      const bool is_low = (static_cast<int>(setting(23)) >> axis & 1) != 0;
      low = is_zero_forced_ && is_low ? 0 : -length;
      high = is_zero_forced_ && is_low ? length : 0;
    }
    target = std::clamp(target, low, high);
    steps.push_back(static_cast<std::int64_t>(target));
  }
  return steps;
}

CommandOutcome GrblDrive::send_motion(const std::vector<std::int64_t>& target, double feed) {
  std::vector<double> positions;
  positions.reserve(axes());
  for (std::size_t i = 0; i < axes(); ++i)
    positions.push_back(static_cast<double>(target[i]) / can_.per_mm[i]);
  const double before = clock_.now();
  const auto answer = session_.ask(grbl_jog(config_.axes, positions, feed));
  if (!answer) {
    // Whether the motion has begun is unknown.
    const PortFault fault = *answer.fault();
    if (session_.take_restart()) lose_position("the controller has restarted");
    path_.add(target, feed, before);
    if (session_.is_interrupted()) return fault;
    session_.begin(session_.interrupts());
    auto stopped = brake();
    if (!stopped) return stopped;
    return PortFault{fault.kind, fault.what + "; the motors have been stopped"};
  }
  const int error = answer.value().error;
  if (error != 0) {
    auto usable = check_usable();
    if (!usable) return usable;
    return refuse(
        fmt::format("the controller refuses a motion: error {} ({})", error, grbl_error_meaning(error)));
  }
  path_.add(target, feed, before);
  accepted_at_ = clock_.now();
  return Accepted{};
}

CommandOutcome GrblDrive::command(std::span<const double> targets, double duration) {
  const unsigned interrupts = session_.interrupts();
  const std::scoped_lock lock(mutex_);
  if (targets.size() != axes())
    return refuse(fmt::format("a command has {} targets; expected {}", targets.size(), axes()));
  if (!std::ranges::all_of(targets, [](double one) { return std::isfinite(one); }) ||
      !std::isfinite(duration) || duration < 0)
    return refuse("targets and the duration must be finite, and the duration not negative");
  session_.begin(interrupts);
  auto usable = check_usable();
  if (!usable) return usable;
  if (!is_known_) return unknown_position();
  const std::vector<std::int64_t> target = clamped(targets);
  if (path_.lag(clock_.now()) > 0 && clock_.now() > checked_at_ + report_period) {
    const auto checked = checked_report();
    if (!checked) return *checked.fault();
  }
  if (path_.lag(clock_.now()) > config_.most_lag) {
    auto stopped = brake();
    if (!stopped) return stopped;
    if (!is_known_) return unknown_position();
  }
  if (target == path_.end()) return Accepted{};
  return send_motion(target, path_.feed_to(target, duration, config_.lead, clock_.now()));
}

CommandOutcome GrblDrive::halt() {
  auto sent = session_.interrupt(is_homing_ ? grbl::reset : grbl::cancel_jog);
  const std::scoped_lock lock(mutex_);
  if (!sent) return sent;
  session_.begin_stop();
  const auto usable = check_usable();
  if (!usable) return alarm_ ? CommandOutcome(Accepted{}) : usable;
  auto stopped = brake();
  if (stopped) return stopped;
  if (const auto alarm = session_.take_alarm()) alarm_ = alarm;
  if (alarm_) {
    // In alarm, nothing moves.
    (void)check_usable();
    return Accepted{};
  }
  if (stopped.fault()->kind == FaultKind::link_lost) {
    (void)session_.act(grbl::hold);
    (void)session_.act(grbl::reset);
    lose_position("the controller has been reset, because it did not answer");
  }
  return stopped;
}

Outcome<DriveReading> GrblDrive::read() {
  const unsigned interrupts = session_.interrupts();
  const std::scoped_lock lock(mutex_);
  session_.begin(interrupts);
  const auto usable = check_usable();
  if (!usable) return *usable.fault();
  if (!is_known_) return unknown_position();
  const auto checked = checked_report();
  if (!checked) return *checked.fault();
  const Report& now = checked.value();
  if (session_.take_restart() || !is_known_) {
    lose_position("the controller has restarted");
    return refuse("the controller has restarted, its position is lost: home it or set its position");
  }
  DriveReading reading;
  reading.time = 0.5 * (now.asked + now.received);
  for (std::size_t i = 0; i < axes(); ++i)
    reading.values.push_back(static_cast<double>(now.steps[i] - zero_[i]));
  reading.moving = now.state == GrblState::jog;
  return reading;
}

}  // namespace flexura
