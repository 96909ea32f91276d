#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "flexura/equipment/grbl_drive.h"

// How a drive begins: connection, homing, zero, and the end of alarms.
namespace flexura {
namespace {

// Finer steps cannot be distinguished in positions with 3 decimals.
constexpr double most_per_mm = 500;

struct Required {
  int number;
  double value;
  const char* why;
};
constexpr Required holding{1, 255, "the motors must hold the tendons when they rest"};
constexpr Required millimetres{13, 0, "reports must be in mm"};

// Makes a version fit for messages: printable, without the empty name after its last colon.
std::string firmware_text(std::string_view text) {
  constexpr std::size_t longest = 60;
  std::string clean;
  for (const char c : text.substr(0, longest))
    if (c >= ' ' && c <= '~') clean += c;
  while (clean.ends_with(':')) clean.pop_back();
  return clean;
}

}  // namespace

CommandOutcome GrblDrive::connect() {
  const unsigned interrupts = session_.interrupts();
  const std::scoped_lock lock(mutex_);
  session_.begin(interrupts);
  is_connected_ = false, is_known_ = false;
  why_unknown_.clear();
  auto reset = session_.reset(config_.connect_timeout);
  if (!reset) return reset;
  (void)session_.take_alarm();
  alarm_.reset();
  const auto build = session_.ask("$I\n");
  if (!build) return *build.fault();
  is_zero_forced_ = false;
  firmware_.clear();
  for (const GrblMessage& one : build.value().said) {
    const auto* const feedback = std::get_if<GrblFeedback>(&one);
    if (feedback != nullptr && feedback->type == "VER") firmware_ = firmware_text(feedback->text);
    if (feedback == nullptr || feedback->type != "OPT") continue;
    // [OPT:codes,blocks,bytes]; Z: homing sets the position to 0.
    const std::string& options = feedback->text;
    is_zero_forced_ = options.substr(0, options.find(',')).find('Z') != std::string::npos;
    const std::size_t second = options.find(',', options.find(',') + 1);
    std::size_t bytes = 0;
    if (second != std::string::npos &&
        std::from_chars(options.data() + second + 1, options.data() + options.size(), bytes).ec ==
            std::errc() &&
        bytes >= grbl::longest_line)
      session_.limit_window(bytes);
  }
  const auto listed = session_.ask("$$\n", 4 * config_.answer_timeout);
  if (!listed) return *listed.fault();
  auto good = check_settings(listed.value().said);
  if (!good) return good;
  const auto status = session_.status();
  if (!status) return *status.fault();
  reported_axes_ = status.value().positions.size();
  if (reported_axes_ <= indices_.back())
    return refuse(fmt::format("the controller reports {} axes, but the drive has the axis {}", reported_axes_,
                              config_.axes.back()));
  if (status.value().state == GrblState::alarm) alarm_ = unknown_alarm;
  is_connected_ = true;
  return Accepted{};
}

CommandOutcome GrblDrive::check_settings(const std::vector<GrblMessage>& said) {
  settings_.clear();
  for (const GrblMessage& one : said) {
    const auto* const setting = std::get_if<GrblSetting>(&one);
    if (setting == nullptr) continue;
    double value = 0;
    const char* const end = setting->value.data() + setting->value.size();
    const auto read = std::from_chars(setting->value.data(), end, value);
    if (read.ec == std::errc() && read.ptr == end) settings_.emplace_back(setting->number, value);
  }
  is_zero_forced_ = is_zero_forced_ || (static_cast<int>(setting(22)) & 8) != 0;
  std::vector<Required> wrong;
  for (const Required& one : {holding, millimetres})
    if (setting(one.number) != one.value) wrong.push_back(one);
  const auto mask = static_cast<int>(setting(10));
  if ((mask & 1) == 0)
    wrong.push_back({10, static_cast<double>(mask | 1), "reports must have machine positions"});
  std::vector<std::string> lines;
  for (const Required& one : wrong) {
    if (!config_.writes_settings)
      return refuse(
          fmt::format("setting ${} is {:g}; {}: send ${}={:g} to the controller, or allow "
                      "writes_settings",
                      one.number, setting(one.number), one.why, one.number, one.value));
    lines.push_back(fmt::format("${}={:g}\n", one.number, one.value));
  }
  const auto written = session_.stream(lines);
  if (!written) return *written.fault();
  if (written.value() != 0)
    return refuse(fmt::format("the controller refuses a setting: error {} ({})", written.value(),
                              grbl_error_meaning(written.value())));
  return check_axes();
}

CommandOutcome GrblDrive::check_axes() {
  can_ = {};
  for (std::size_t i = 0; i < axes(); ++i) {
    const auto axis = static_cast<int>(indices_[i]);
    const double per_mm = setting(100 + axis), rate = setting(110 + axis), acceleration = setting(120 + axis);
    const bool is_countable = per_mm > 0 && per_mm <= most_per_mm;
    if (!is_countable)
      return refuse(
          fmt::format("setting ${} is {:g} steps/mm; expected above 0, at most {:g}, because positions "
                      "have 3 decimals. A \"mm\" of the controller need not be a real millimetre, so 100 is "
                      "a good choice for all axes",
                      100 + axis, per_mm, most_per_mm));
    if (!(rate > 0 && acceleration > 0 && std::isfinite(rate) && std::isfinite(acceleration)))
      return refuse(fmt::format("settings ${} and ${} must be above 0", 110 + axis, 120 + axis));
    can_.per_mm.push_back(per_mm);
    can_.rates.push_back(rate / 60);
    can_.accelerations.push_back(acceleration);
  }
  path_ = GrblPath(can_);
  return Accepted{};
}

GrblIdentity GrblDrive::identity() const {
  const std::scoped_lock lock(mutex_);
  GrblIdentity identity{.firmware = firmware_,
                        .has_soft_limits = setting(20) != 0,
                        .has_homing = (static_cast<int>(setting(22)) & 1) != 0};
  for (std::size_t i = 0; i < can_.per_mm.size(); ++i) {
    identity.rates.push_back(can_.rates[i] * can_.per_mm[i]);
    identity.accelerations.push_back(can_.accelerations[i] * can_.per_mm[i]);
    identity.travel.push_back(setting(130 + static_cast<int>(indices_[i])) * can_.per_mm[i]);
  }
  return identity;
}

Outcome<GrblStatus> GrblDrive::status() {
  const unsigned interrupts = session_.interrupts();
  const std::scoped_lock lock(mutex_);
  session_.begin(interrupts);
  if (!is_connected_) return refuse("not connected");
  return session_.status();
}

CommandOutcome GrblDrive::home(std::span<const double> positions) {
  const unsigned interrupts = session_.interrupts();
  const std::scoped_lock lock(mutex_);
  if (positions.size() != axes() ||
      !std::ranges::all_of(positions, [](double one) { return std::isfinite(one); }))
    return refuse("homing needs one finite position per axis");
  session_.begin(interrupts);
  if (!is_connected_) return refuse("not connected");
  (void)check_usable();  // An alarm does not prevent homing.
  lose_position("homing has not ended");
  is_homing_ = true;
  const auto answer = session_.ask("$H\n", config_.homing_timeout);
  is_homing_ = false;
  const auto alarm = session_.take_alarm();
  if (alarm) {
    alarm_ = alarm;
    return refuse(fmt::format("homing failed: alarm {} ({})", *alarm, grbl_alarm_meaning(*alarm)));
  }
  if (!answer) {
    if (!session_.is_interrupted()) (void)session_.act(grbl::reset);  // It may still be moving.
    return *answer.fault();
  }
  if (answer.value().error != 0)
    return refuse(fmt::format("homing failed: error {} ({})", answer.value().error,
                              grbl_error_meaning(answer.value().error)));
  alarm_.reset();
  (void)session_.take_restart();
  auto stopped = stop_and_locate();
  if (!stopped) return stopped;
  for (std::size_t i = 0; i < axes(); ++i)
    zero_[i] = path_.end()[i] - static_cast<std::int64_t>(std::llround(std::clamp(positions[i], -4e6, 4e6)));
  is_known_ = true;
  return Accepted{};
}

CommandOutcome GrblDrive::set_positions(std::span<const double> positions) {
  const unsigned interrupts = session_.interrupts();
  const std::scoped_lock lock(mutex_);
  if (positions.size() != axes() ||
      !std::ranges::all_of(positions, [](double one) { return std::isfinite(one); }))
    return refuse("a zero needs one finite position per axis");
  session_.begin(interrupts);
  auto usable = check_usable();
  if (!usable) return usable;
  const auto asked = report();
  if (!asked) return *asked.fault();
  if (asked.value().state == GrblState::jog)
    return refuse("the position cannot be set while the motors move");
  auto stopped = stop_and_locate();
  if (!stopped) return stopped;
  for (std::size_t i = 0; i < axes(); ++i)
    zero_[i] = path_.end()[i] - static_cast<std::int64_t>(std::llround(std::clamp(positions[i], -4e6, 4e6)));
  is_known_ = true;
  return Accepted{};
}

CommandOutcome GrblDrive::unlock() {
  const unsigned interrupts = session_.interrupts();
  const std::scoped_lock lock(mutex_);
  session_.begin(interrupts);
  if (!is_connected_) return refuse("not connected");
  (void)check_usable();
  const bool was_known = is_known_;
  (void)session_.act(grbl::hold);
  auto reset = session_.reset(config_.connect_timeout);
  if (!reset) return reset;
  const auto alarm = session_.take_alarm();
  is_known_ = was_known;
  if (alarm) lose_position("after an alarm");
  const auto answer = session_.ask("$X\n");
  if (!answer) return *answer.fault();
  if (answer.value().error != 0)
    return refuse(fmt::format("the controller stays locked: error {} ({})", answer.value().error,
                              grbl_error_meaning(answer.value().error)));
  alarm_.reset();
  const auto asked = report();
  if (!asked) return *asked.fault();
  path_.stop(asked.value().steps, asked.value().asked);
  return Accepted{};
}

}  // namespace flexura
