#include "flexura/equipment/grbl_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

constexpr int power_lost = -1;

std::map<int, double> default_settings(std::size_t axes) {
  // gnea/grbl, doc/markdown/settings.md; $1=255 holds the motors, $10=3 reports MPos and Bf.
  std::map<int, double> settings{{0, 10}, {1, 255},   {2, 0},     {3, 0},      {4, 0},    {5, 0},
                                 {6, 0},  {10, 3},    {11, 0.01}, {12, 0.002}, {13, 0},   {20, 0},
                                 {21, 0}, {22, 0},    {23, 0},    {24, 25},    {25, 500}, {26, 250},
                                 {27, 1}, {30, 1000}, {31, 0},    {32, 0}};
  for (int axis = 0; axis < static_cast<int>(axes); ++axis) {
    settings[100 + axis] = 100;
    settings[110 + axis] = 6000;
    settings[120 + axis] = 1000;
    settings[130 + axis] = 200;
  }
  return settings;
}

}  // namespace

GrblDevice::GrblDevice(GrblDeviceConfig config)
    : config_(std::move(config)),
      settings_(default_settings(config_.axes)),
      motion_(config_.axes, config_.is_grblhal ? 35 : 15),
      slips_(config_.axes, 0),
      shift_(config_.axes, 0),
      receive_size_(config_.is_grblhal ? 1024 : 128) {
  if (config_.axes < 1 || config_.axes > grbl::most_axes)
    throw std::invalid_argument("a Grbl controller has 1 to 8 axes");
  for (const std::vector<double>* ends : {&config_.low, &config_.high})
    if (!ends->empty() && ends->size() != config_.axes)
      throw std::invalid_argument("expected one limit switch per axis and end");
  for (const auto& [number, value] : config_.settings) settings_[number] = value;
  for (auto& system : systems_) system.assign(config_.axes, 0);
  for (auto& place : places_) place.assign(config_.axes, 0);
  reset(true);
}

std::vector<std::string> GrblDevice::receive(std::string_view bytes, double now) {
  pass_to(now);
  for (const char byte : bytes) hear(byte);
  return std::exchange(said_, {});
}

std::vector<std::string> GrblDevice::advance(double now) {
  pass_to(now);
  return std::exchange(said_, {});
}

std::vector<double> GrblDevice::positions(double now) {
  pass_to(now);
  return motors();
}

std::vector<double> GrblDevice::motors() const {
  if (homing_) return homing_->motors;
  std::vector<double> motors(slips_);
  for (std::size_t i = 0; i < motors.size(); ++i) motors[i] += std::round(motion_.position()[i] * per_mm(i));
  return motors;
}

GrblState GrblDevice::state() const {
  if (homing_) return GrblState::home;
  return state_;
}

double GrblDevice::setting(int number) const {
  const auto found = settings_.find(number);
  return found == settings_.end() ? 0 : found->second;
}

void GrblDevice::restart(double now) {
  pass_to(now);
  reset(true);
}

void GrblDevice::raise_alarm(int code, double now) {
  pass_to(now);
  if (code != 2) stop_motors();
  motion_.reset();
  homing_.reset();
  state_ = GrblState::alarm;
  say(fmt::format("ALARM:{}", code));
  needs_reset_ = code == 1 || code == 2;
  if (needs_reset_) say("[MSG:Reset to continue]");
}

// Time passes in ticks while anything moves or waits, so that the result does not depend on when this is
// called.
void GrblDevice::pass_to(double now) {
  constexpr double tick = GrblMotion::tick;
  if (!(now > time_)) return;
  if (boots_at_ && *boots_at_ <= now) {
    time_ = std::max(time_, *boots_at_);
    boots_at_.reset();
    greet();
  }
  while (time_ + tick <= now) {
    const bool is_busy = !motion_.is_idle() || homing_ || waiting_ || dwell_end_;
    if (!is_busy) {
      time_ = now;
      return;
    }
    time_ += tick;
    if (homing_) {
      home_for_tick();
    } else {
      motion_.step();
    }
    after_tick();
  }
}

void GrblDevice::after_tick() {
  if (setting(21) != 0 && !homing_ && motion_.speed() > 0) {
    for (std::size_t i = 0; i < config_.axes; ++i) {
      if (!is_at_switch(i)) continue;
      raise_alarm(1, time_);
      break;
    }
  }
  if (is_canceling_ && motion_.is_resting()) {
    is_canceling_ = false;
    motion_.reset();
    if (state_ == GrblState::jog) state_ = GrblState::idle;
  }
  if ((state_ == GrblState::run || state_ == GrblState::jog) && motion_.is_idle()) state_ = GrblState::idle;
  read_lines();
}

bool GrblDevice::is_at_switch(std::size_t axis) const {
  const double motor = motors()[axis];
  return (!config_.low.empty() && motor < config_.low[axis]) ||
         (!config_.high.empty() && motor > config_.high[axis]);
}

void GrblDevice::hear(char byte) {
  if (boots_at_) return;
  const auto code = static_cast<unsigned char>(byte);
  if (byte == grbl::ask_status || byte == grbl::hold || byte == grbl::resume || byte == grbl::reset ||
      code >= 0x80) {
    act(byte);
    return;
  }
  if (needs_reset_) return;
  if (received_.size() >= receive_size_) {
    ++lost_bytes_;
    return;
  }
  received_ += byte;
  if (byte == '\n' || byte == '\r') read_lines();
}

void GrblDevice::act(char byte) {
  if (byte == grbl::reset) {
    reset(false);
    return;
  }
  if (byte == grbl::ask_status) {
    const bool is_deaf = needs_reset_ || (homing_ && !config_.is_grblhal);
    if (!is_deaf) report();
    return;
  }
  if (byte == grbl::hold || byte == grbl::cancel_jog) {
    if (state_ == GrblState::jog) {
      is_canceling_ = true;
      motion_.brake();
    } else if (byte == grbl::hold && !homing_ && (state_ == GrblState::run || state_ == GrblState::idle)) {
      state_ = GrblState::hold;
      motion_.brake();
    }
    return;
  }
  if (byte == grbl::resume && state_ == GrblState::hold && motion_.is_resting()) {
    motion_.resume();
    state_ = motion_.is_idle() ? GrblState::idle : GrblState::run;
    read_lines();
  }
}

// The pulses end at once, but the motors turn on a little.
void GrblDevice::stop_motors() {
  for (std::size_t i = 0; i < config_.axes; ++i)
    slips_[i] += std::round(motion_.direction()[i] * motion_.speed() * per_mm(i) * config_.overrun);
}

void GrblDevice::reset(bool is_power) {
  int alarm = 0;
  if (is_power) {
    alarm = power_lost;
  } else if (homing_) {
    alarm = 6;
  } else if (state_ == GrblState::run || state_ == GrblState::jog || motion_.speed() > 0) {
    alarm = 3;
  }
  if (homing_) {
    // The count is wrong by what homing has moved.
    for (std::size_t i = 0; i < config_.axes; ++i)
      slips_[i] = homing_->motors[i] - std::round(motion_.position()[i] * per_mm(i));
    homing_.reset();
  }
  stop_motors();
  motion_.reset();
  if (is_power) {
    // The motors stay where they are, the count does not.
    slips_ = motors();
    motion_.reset(std::vector<double>(config_.axes, 0));
    state_ = setting(22) != 0 ? GrblState::alarm : GrblState::idle;
    boots_at_ = time_ + config_.boot_time;
    said_.clear();
  } else if (alarm != 0) {
    say(fmt::format("ALARM:{}", alarm));
    state_ = GrblState::alarm;
  } else if (state_ != GrblState::alarm) {
    state_ = state_ == GrblState::sleep ? GrblState::alarm : GrblState::idle;
  }
  received_.clear(), line_.clear();
  waiting_.reset(), dwell_end_.reset();
  is_canceling_ = false, needs_reset_ = false, is_line_too_long_ = false, is_homed_ = false;
  modes_ = {};
  std::ranges::fill(shift_, 0);
  until_offset_ = 0;
  if (!is_power) greet();
}

void GrblDevice::greet() {
  say("");
  say(config_.is_grblhal ? "GrblHAL 1.1f ['$' or '$HELP' for help]" : "Grbl 1.1h ['$' for help]");
  if (state_ == GrblState::alarm) say("[MSG:'$H'|'$X' to unlock]");
}

void GrblDevice::report() {
  GrblStatus status{.state = state()};
  const bool is_moving = !motion_.is_resting();
  if (state_ == GrblState::hold) status.part = is_moving ? 1 : 0;
  const auto mask = static_cast<int>(setting(10));
  const double unit = setting(13) != 0 ? 25.4 : 1;
  std::vector<double> work = offset();
  status.is_work = (mask & 1) == 0;
  for (std::size_t i = 0; i < config_.axes; ++i) {
    const double counted = std::round(motion_.position()[i] * per_mm(i)) / per_mm(i);
    status.positions.push_back((counted - (status.is_work ? work[i] : 0)) / unit);
    work[i] /= unit;
  }
  if ((mask & 2) != 0) {
    status.free_blocks = static_cast<std::int64_t>(motion_.free_blocks());
    status.free_bytes = static_cast<std::int64_t>(receive_size_ - received_.size());
  }
  status.feed = 60 * motion_.speed() / unit;
  for (std::size_t i = 0; i < config_.axes; ++i)
    if (is_at_switch(i)) status.pins += grbl::axis_letters[i];
  const bool has_overrides = until_offset_ == 1;
  if (until_offset_-- <= 0) {
    status.offset = work;
    until_offset_ = is_moving ? 30 : 10;
  }
  std::string line = text(status);
  if (has_overrides) line.insert(line.size() - 1, "|Ov:100,100,100");
  say(std::move(line));
}

GrblLimits GrblDevice::limits() const {
  GrblLimits limits{.rates = {}, .accelerations = {}, .junction_deviation = setting(11)};
  for (int axis = 0; axis < static_cast<int>(config_.axes); ++axis) {
    limits.rates.push_back(std::max(setting(110 + axis) / 60, 1e-6));
    limits.accelerations.push_back(std::max(setting(120 + axis), 1e-6));
  }
  return limits;
}

int GrblDevice::start_homing() {
  if (setting(22) == 0) return 5;
  homing_ =
      Homing{.phase = 0, .from = motors(), .motors = motors(), .is_done = std::vector<bool>(config_.axes)};
  return 0;
}

// Towards the switches, away, slowly again, away (gnea/grbl, doc/markdown/settings.md, $22 to $27). All axes
// move at once; a real controller homes Z first.
void GrblDevice::home_for_tick() {
  Homing& homing = *homing_;
  const bool is_approach = homing.phase % 2 == 0;
  const double speed = setting(homing.phase < 2 ? 25 : 24) / 60;
  for (std::size_t i = 0; i < config_.axes; ++i) {
    if (homing.is_done[i]) continue;
    const bool is_low = (static_cast<int>(setting(23)) >> i & 1) != 0;
    const double way = (is_low ? -1 : 1) * (is_approach ? 1 : -1);
    homing.motors[i] += way * speed * GrblMotion::tick * per_mm(i);
    const double gone = std::abs(homing.motors[i] - homing.from[i]) / per_mm(i);
    if (is_approach) {
      homing.is_done[i] = is_at_switch(i);
      const double most = homing.phase == 0 ? 1.5 * setting(130 + static_cast<int>(i)) : 5 * setting(27);
      if (!homing.is_done[i] && gone > most) {
        reset(false);
        said_.clear();
        say("ALARM:9");
        greet();
        waiting_.reset();
        return;
      }
    } else {
      homing.is_done[i] = gone >= setting(27);
    }
  }
  if (!std::ranges::all_of(homing.is_done, std::identity())) return;
  for (double& motor : homing.motors) motor = std::round(motor);
  homing.from = homing.motors;
  homing.is_done.assign(config_.axes, false);
  if (++homing.phase == 4) end_homing();
}

void GrblDevice::end_homing() {
  std::vector<double> position(config_.axes, 0);
  const bool is_zero = (static_cast<int>(setting(22)) & 8) != 0;
  for (std::size_t i = 0; i < config_.axes; ++i) {
    const bool is_low = (static_cast<int>(setting(23)) >> i & 1) != 0;
    if (!is_zero) position[i] = is_low ? setting(27) - setting(130 + static_cast<int>(i)) : -setting(27);
    const double steps = std::round(position[i] * per_mm(i));
    position[i] = steps / per_mm(i);
    slips_[i] = homing_->motors[i] - steps;
  }
  homing_.reset();
  motion_.reset(position);
  state_ = GrblState::idle;
  is_homed_ = true;
}

}  // namespace flexura
