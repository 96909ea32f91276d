#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "flexura/equipment/grbl_device.h"

// What a simulated controller does with lines.
namespace flexura {
namespace {

constexpr double rapid = std::numeric_limits<double>::infinity();

std::string triple(const std::vector<double>& numbers) {
  std::string list;
  for (const double number : numbers) list += fmt::format("{}{:.3f}", list.empty() ? "" : ",", number);
  return list;
}

// Returns the code of the error that the G words of a line make together or alone, or 0.
int check_words(const GrblBlock& block) {
  constexpr std::array<double, 29> known{0,  1,  4,  10, 17, 18, 19, 20, 21, 28, 30, 40,   49, 53, 54,
                                         55, 56, 57, 58, 59, 80, 90, 91, 92, 93, 94, 91.1, 61, 64};
  const auto count = [&](auto is_in) { return std::ranges::count_if(block.g, is_in); };
  if (!std::ranges::all_of(block.g, [&](double g) { return std::ranges::find(known, g) != known.end(); }))
    return 20;
  if (count([](double g) { return g == 0 || g == 1 || g == 80; }) > 1 ||
      count([](double g) { return g == 90 || g == 91; }) > 1 ||
      count([](double g) { return g == 20 || g == 21; }) > 1 ||
      count([](double g) { return g >= 54 && g <= 59; }) > 1 ||
      count([](double g) { return g == 93 || g == 94; }) > 1)
    return 21;
  const auto taking_axes = count([](double g) { return g == 10 || g == 28 || g == 30 || g == 92; });
  if (taking_axes > 1) return 24;
  return 0;
}

}  // namespace

bool GrblDevice::is_blocked() const {
  return boots_at_ || homing_ || needs_reset_ || is_canceling_ || state_ == GrblState::hold ||
         state_ == GrblState::sleep;
}

void GrblDevice::read_lines() {
  for (;;) {
    if (is_blocked()) return;
    if (waiting_) {
      const std::optional<int> code = run(*waiting_);
      if (!code) return;
      waiting_.reset();
      answer(*code);
      continue;
    }
    const std::size_t end = received_.find_first_of("\r\n");
    if (end == std::string::npos) {
      // Grbl moves bytes into its line as they come.
      line_ += received_;
      received_.clear();
      if (line_.size() > 4 * grbl::longest_line) is_line_too_long_ = true, line_.clear();
      return;
    }
    line_ += received_.substr(0, end);
    received_.erase(0, end + 1);
    std::string line = std::exchange(line_, {});
    const std::size_t most = config_.is_grblhal ? 256 : grbl::longest_line - 1;
    if (std::exchange(is_line_too_long_, false) || line.size() > most) {
      answer(11);
      continue;
    }
    waiting_ = std::move(line);
  }
}

void GrblDevice::answer(int code) { say(code == 0 ? std::string("ok") : fmt::format("error:{}", code)); }

std::optional<int> GrblDevice::run(const std::string& line) {
  if (line.empty()) return 0;
  if (line.front() == '$') return run_command(line);
  if (state_ == GrblState::alarm || state_ == GrblState::jog) return 9;
  return run_gcode(line);
}

std::optional<int> GrblDevice::run_command(const std::string& line) {
  const bool is_still = state_ == GrblState::idle || state_ == GrblState::alarm;
  if (line.starts_with("$J=")) {
    if (state_ != GrblState::idle && state_ != GrblState::jog) return 8;
    return run_jog(std::string_view(line).substr(3));
  }
  if (line == "$") return say("[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ~ ! ? ctrl-x]"), 0;
  if (line == "$$") return state_ == GrblState::run ? 8 : (print_settings(), 0);
  if (line == "$G") return print_modes(), 0;
  if (line == "$X") {
    if (state_ == GrblState::alarm) {
      say("[MSG:Caution: Unlocked]");
      state_ = GrblState::idle;
    }
    return 0;
  }
  if (line == "$C") {
    if (state_ == GrblState::check) return say("[MSG:Disabled]"), reset(false), 0;
    if (state_ != GrblState::idle) return 8;
    return say("[MSG:Enabled]"), state_ = GrblState::check, 0;
  }
  if (!is_still) return 8;
  if (line == "$#") return print_places(), 0;
  if (line == "$I" || line == "$I+") return print_build(), 0;
  if (line == "$N") return say("$N0="), say("$N1="), 0;
  if (line == "$H") {
    if (homing_) return std::nullopt;
    // read_lines() asks again when homing is over.
    if (std::exchange(is_homed_, false)) return 0;
    const int code = start_homing();
    if (code != 0) return code;
    return std::nullopt;
  }
  if (line == "$SLP") return say("[MSG:Sleeping]"), state_ = GrblState::sleep, 0;
  if (line.find('=') != std::string::npos) return set(std::string_view(line).substr(1));
  return 3;
}

int GrblDevice::set(std::string_view assignment) {
  const std::size_t equals = assignment.find('=');
  const std::string_view name = assignment.substr(0, equals), text = assignment.substr(equals + 1);
  if (name == "N0" || name == "N1" || name == "I" || name == "RST") return 0;
  int number = 0;
  double value = 0;
  const auto [name_end, name_error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (name_error != std::errc() || name_end != name.data() + name.size()) return 3;
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return 2;
  if (!settings_.contains(number)) return 3;
  if (value < 0 || value > 1e9) return 4;
  if (number >= 100 && value == 0) return 4;
  if (number == 20 && value != 0 && setting(22) == 0) return 10;
  if (number == 22 && value == 0) settings_[20] = 0;
  // The count of steps stays, so its length in mm changes.
  const std::vector<double> before = motors();
  settings_[number] = value;
  std::vector<double> position(config_.axes);
  for (std::size_t i = 0; i < config_.axes; ++i) position[i] = (before[i] - slips_[i]) / per_mm(i);
  if (number >= 100 && number < 108) motion_.reset(position);
  return 0;
}

std::optional<int> GrblDevice::run_jog(std::string_view words) {
  const auto parsed = parse_gcode(words, config_.axes);
  if (const auto* const code = std::get_if<int>(&parsed)) return *code;
  const auto& block = std::get<GrblBlock>(parsed);
  const auto is_allowed = [](double g) { return g == 20 || g == 21 || g == 53 || g == 90 || g == 91; };
  if (!std::ranges::all_of(block.g, is_allowed) || !block.m.empty() || block.p || block.l) return 16;
  if (const int code = check_words(block); code != 0) return code;
  if (!block.has_axes()) return 26;
  if (!block.feed || *block.feed == 0) return 22;
  double unit = modes_.unit;
  if (block.has(20)) unit = 25.4;
  if (block.has(21)) unit = 1;
  const bool is_absolute = block.has(90) || (modes_.is_absolute && !block.has(91));
  const std::vector<double> target = target_of(block, is_absolute, block.has(53), unit);
  if (setting(20) != 0 && is_outside(target)) return 15;
  if (motion_.is_full()) return std::nullopt;
  if (ignores_motions_) return 0;
  motion_.add(target, *block.feed * unit / 60, limits());
  if (!motion_.is_idle()) state_ = GrblState::jog;
  return 0;
}

std::optional<int> GrblDevice::run_gcode(const std::string& line) {
  const auto parsed = parse_gcode(line, config_.axes);
  if (const auto* const code = std::get_if<int>(&parsed)) return *code;
  const auto& block = std::get<GrblBlock>(parsed);
  if (const int code = check_words(block); code != 0) return code;
  for (const double word : block.m)
    if (word != std::floor(word)) return 23;
  if (block.has(4)) {
    if (!block.p) return 28;
    if (state_ == GrblState::check) return 0;
    if (!motion_.is_idle()) return std::nullopt;
    if (!dwell_end_) dwell_end_ = time_ + std::min(*block.p, 1e6);
    if (time_ < *dwell_end_) return std::nullopt;
    dwell_end_.reset();
  }
  // A line that waits for room is read again, so this must have the same effect each time.
  for (const double word : block.g) {
    if (word == 0 || word == 1 || word == 80) modes_.motion = static_cast<int>(word);
    if (word >= 17 && word <= 19) modes_.plane = static_cast<int>(word);
    if (word == 20 || word == 21) modes_.unit = word == 20 ? 25.4 : 1;
    if (word >= 54 && word <= 59) modes_.system = static_cast<std::size_t>(word - 54);
    if (word == 90 || word == 91) modes_.is_absolute = word == 90;
    if (word == 93 || word == 94) modes_.is_inverse_time = word == 93;
  }
  if (block.feed && !modes_.is_inverse_time) modes_.feed = *block.feed * modes_.unit;
  for (const double word : block.m) {
    if (word == 2 || word == 30) {
      modes_ = {.feed = modes_.feed};
      say("[MSG:Pgm End]");
    }
  }
  return run_motion(block);
}

std::optional<int> GrblDevice::run_motion(const GrblBlock& block) {
  const std::vector<double> target = target_of(block, modes_.is_absolute, block.has(53), modes_.unit);
  if (block.has(10)) {
    const double p = block.p.value_or(-1), l = block.l.value_or(-1);
    if (p < 0 || (l != 2 && l != 20)) return 28;
    if (p > 6) return 29;
    std::vector<double>& system = systems_[p == 0 ? modes_.system : static_cast<std::size_t>(p - 1)];
    for (std::size_t i = 0; i < config_.axes; ++i) {
      if (!block.axes[i]) continue;
      const double value = *block.axes[i] * modes_.unit;
      system[i] = l == 2 ? value : motion_.last()[i] - value - shift_[i];
    }
    until_offset_ = 0;
    return 0;
  }
  if (block.has(92)) {
    for (std::size_t i = 0; i < config_.axes; ++i)
      if (block.axes[i])
        shift_[i] = motion_.last()[i] - systems_[modes_.system][i] - *block.axes[i] * modes_.unit;
    until_offset_ = 0;
    return 0;
  }
  if (block.has(28) || block.has(30)) return move_to(places_[block.has(30) ? 1 : 0], rapid);
  if (!block.has_axes()) return 0;
  if (modes_.motion == 80) return 31;
  double feed = rapid;
  if (modes_.motion == 1) {
    feed = modes_.feed / 60;
    if (modes_.is_inverse_time) {
      if (!block.feed) return 22;
      double length = 0;
      for (std::size_t i = 0; i < config_.axes; ++i)
        length = std::hypot(length, target[i] - motion_.last()[i]);
      feed = length * *block.feed / 60;
    }
    if (!(feed > 0)) return 22;
  }
  return move_to(target, feed);
}

std::optional<int> GrblDevice::move_to(const std::vector<double>& target, double feed) {
  if (state_ == GrblState::check) return 0;
  if (setting(20) != 0 && is_outside(target)) {
    raise_alarm(2, time_);
    return 0;
  }
  if (motion_.is_full()) return std::nullopt;
  if (ignores_motions_) return 0;
  motion_.add(target, feed, limits());
  if (!motion_.is_idle()) state_ = GrblState::run;
  return 0;
}

std::vector<double> GrblDevice::offset() const {
  std::vector<double> sum(systems_[modes_.system]);
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += shift_[i];
  return sum;
}

// Returns the target on whole steps, mm.
std::vector<double> GrblDevice::target_of(const GrblBlock& block, bool is_absolute, bool is_machine,
                                          double unit) const {
  std::vector<double> target = motion_.last();
  const std::vector<double> work = offset();
  for (std::size_t i = 0; i < config_.axes; ++i) {
    if (!block.axes[i]) continue;
    double to = *block.axes[i] * unit;
    if (!is_absolute && !is_machine) to += target[i];
    if (is_absolute && !is_machine) to += work[i];
    target[i] = std::round(std::clamp(to, -1e9, 1e9) * per_mm(i)) / per_mm(i);
  }
  return target;
}

bool GrblDevice::is_outside(const std::vector<double>& target) const {
  const bool is_zero = (static_cast<int>(setting(22)) & 8) != 0;
  for (std::size_t i = 0; i < config_.axes; ++i) {
    const bool is_low = (static_cast<int>(setting(23)) >> i & 1) != 0;
    const double travel = setting(130 + static_cast<int>(i));
    const double low = is_zero && is_low ? 0 : -travel, high = is_zero && is_low ? travel : 0;
    if (target[i] < low || target[i] > high) return true;
  }
  return false;
}

void GrblDevice::print_settings() {
  for (const auto& [number, value] : settings_) {
    const bool is_decimal =
        number == 11 || number == 12 || (number >= 24 && number != 26 && number < 30) || number >= 100;
    say(is_decimal ? fmt::format("${}={:.3f}", number, value) : fmt::format("${}={:.0f}", number, value));
  }
}

void GrblDevice::print_places() {
  for (std::size_t i = 0; i < systems_.size(); ++i) say(fmt::format("[G{}:{}]", 54 + i, triple(systems_[i])));
  say(fmt::format("[G28:{}]", triple(places_[0])));
  say(fmt::format("[G30:{}]", triple(places_[1])));
  say(fmt::format("[G92:{}]", triple(shift_)));
  say("[TLO:0.000]");
  say(fmt::format("[PRB:{}:0]", triple(std::vector<double>(config_.axes, 0))));
}

void GrblDevice::print_build() {
  say(config_.is_grblhal ? "[VER:1.1f.20240101:]" : "[VER:1.1h.20190830:]");
  say(fmt::format("[OPT:V,{},{}{}]", motion_.free_blocks(), receive_size_,
                  config_.is_grblhal ? fmt::format(",{},0", config_.axes) : ""));
  if (!config_.is_grblhal) return;
  say(fmt::format("[AXS:{}:{}]", config_.axes, grbl::axis_letters.substr(0, config_.axes)));
  say("[FIRMWARE:grblHAL]");
}

void GrblDevice::print_modes() {
  say(fmt::format("[GC:G{} G{} G{} G{} G{} G{} M5 M9 T0 F{:.0f} S0]", modes_.motion, 54 + modes_.system,
                  modes_.plane, modes_.unit == 1 ? 21 : 20, modes_.is_absolute ? 90 : 91,
                  modes_.is_inverse_time ? 93 : 94, modes_.feed));
}

}  // namespace flexura
