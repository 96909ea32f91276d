// Set-up, power and homing of the drives.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "flexura/equipment/cia402_drive.h"

namespace flexura {
namespace {

constexpr double cia402_poll_interval = 0.002;  // s

// Makes text from a device fit for messages: printable characters, at most 60.
std::string printable_name(const std::string& text) {
  std::string clean;
  std::ranges::copy_if(text.substr(0, 60), std::back_inserter(clean),
                       [](char c) { return c >= ' ' && c <= '~'; });
  return clean;
}

}  // namespace

CommandOutcome Cia402Drive::start() {
  const unsigned halts = halts_;
  const std::scoped_lock lock(mutex_);
  halts_seen_ = halts;
  is_started_ = has_pdos_ = false;
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (const auto done = set_up(i); !done) return unusable(*done.fault());
    axes_[i].has_target = false;
    axes_[i].last_position.reset();
    axes_[i].word = 0;
  }
  if (const auto started = start_nodes(); !started) return unusable(*started.fault());
  has_pdos_ = true;
  // A drive may still hold a target of an interrupted command, which the next SYNC would start. These words
  // replace it. Several, because a frame may be lost.
  for (std::int64_t tried = 0; tried < config_.tries; ++tried)
    for (std::size_t i = 0; i < axes_.size(); ++i)
      if (const auto sent = send_word(i, control_word::enable); !sent) return unusable(*sent.fault());
  if (const auto enabled = enable(true); !enabled) return unusable(*enabled.fault());
  is_started_ = true;
  return Accepted{};
}

// A program that has died may have left a motion.
CommandOutcome Cia402Drive::end_motion(std::size_t i) {
  const auto status = bus_.read(i, {0x6041, 0});
  if (!status) return *status.fault();
  const auto word = static_cast<std::uint16_t>(status.value().number());
  const bool may_move =
      drive_state(word) == DriveState::operation_enabled && (word & status_bit::target_reached) == 0;
  if (!may_move) return Accepted{};
  return bus_.write(i, {0x6040, 0}, control_word::quick_stop, 2);
}

// A node ignores PDOs until it is operational, and the command to become operational may be late or lost.
// Only a heartbeat shows its state.
CommandOutcome Cia402Drive::start_nodes() {
  for (std::size_t i = 0; i < axes_.size(); ++i) bus_.node(i).state = NmtState::pre_operational;
  const double begin = bus_.now(), end = begin + std::max(config_.power_timeout, 2.5 * config_.heartbeat);
  double next = begin;
  for (;;) {
    std::optional<std::size_t> waiting;
    for (std::size_t i = 0; i < axes_.size(); ++i)
      if (bus_.node(i).state != NmtState::operational) waiting = i;
    if (!waiting) return Accepted{};
    const double now = bus_.now();
    if (now > end)
      return bus_.fault(*waiting, FaultKind::refused,
                        "does not become operational, or sends no heartbeat; check object 0x1017");
    if (now >= next) {
      keep_alive();
      for (std::size_t i = 0; i < axes_.size(); ++i)
        if (bus_.node(i).state != NmtState::operational)
          if (const auto sent = bus_.send(nmt_frame(NmtCommand::start, bus_.node(i).number)); !sent)
            return sent;
      // A node answers by its next heartbeat.
      next = now + std::max(config_.answer_timeout, 1.5 * config_.heartbeat);
    }
    if (const auto paused = bus_.pause(cia402_poll_interval); !paused) return paused;
  }
}

CommandOutcome Cia402Drive::identify(std::size_t i) {
  const auto type = bus_.read(i, {0x1000, 0});
  if (!type) return *type.fault();
  if ((type.value().number() & 0xFFFF) != 402)
    return bus_.fault(i, FaultKind::refused,
                      fmt::format("is not a drive of CiA 402 (device type 0x{:08X})", type.value().number()));
  Cia402Identity& identity = axes_[i].identity;
  identity = {};
  const auto name = bus_.run(i, SdoTransfer::reading(bus_.node(i).number, {0x1008, 0}), {0x1008, 0});
  if (!name) return *name.fault();
  if (name.value().abort_code() == 0) identity.name = printable_name(name.value().data());
  for (const std::uint8_t sub : {std::uint8_t{1}, std::uint8_t{2}}) {
    const auto number = bus_.run(i, SdoTransfer::reading(bus_.node(i).number, {0x1018, sub}), {0x1018, sub});
    if (!number) return *number.fault();
    if (number.value().abort_code() == 0)
      (sub == 1 ? identity.vendor : identity.product) = number.value().number();
  }
  return Accepted{};
}

CommandOutcome Cia402Drive::write_checked(std::size_t i, ObjectAddress object, std::int64_t value, int size) {
  const auto bits = static_cast<std::uint32_t>(value);
  if (const auto written = bus_.write(i, object, bits, size); !written) return written;
  const auto back = bus_.read(i, object);
  if (!back) return *back.fault();
  const std::uint32_t mask = size == 4 ? 0xFFFFFFFFU : (1U << static_cast<unsigned>(8 * size)) - 1;
  if ((back.value().number() & mask) == (bits & mask)) return Accepted{};
  return bus_.fault(
      i, FaultKind::refused,
      fmt::format("accepts {} for object {}, but then has {}; look for the limits in its manual", value,
                  text(object), static_cast<std::int32_t>(back.value().number())));
}

CommandOutcome Cia402Drive::write_optional(std::size_t i, ObjectAddress object, std::int64_t value,
                                           int size) {
  const auto done = bus_.run(
      i, SdoTransfer::writing(bus_.node(i).number, object, static_cast<std::uint32_t>(value), size), object);
  if (!done) return *done.fault();
  if (const std::uint32_t code = done.value().abort_code(); code != 0)
    axes_[i].identity.notes.push_back(
        fmt::format("object {} keeps its value: {}", text(object), sdo_abort_text(code)));
  return Accepted{};
}

CommandOutcome Cia402Drive::map_pdo(std::size_t i, std::uint16_t parameters, std::uint32_t id,
                                    std::uint8_t type, const std::vector<std::uint32_t>& objects) {
  const auto mapping = static_cast<std::uint16_t>(parameters + 0x200);
  const auto before = bus_.read(i, {parameters, 1});
  if (!before) return *before.fault();
  // Bit 31: switched off. Bit 30 (no remote requests) stays as it is.
  const std::uint32_t used = (before.value().number() & 0x40000000) | (id + bus_.node(i).number);
  if (const auto done = bus_.write(i, {parameters, 1}, used | 0x80000000, 4); !done) return done;
  if (const auto done = bus_.write(i, {parameters, 2}, type, 1); !done) return done;
  if (const auto done = bus_.write(i, {mapping, 0}, 0, 1); !done) return done;
  for (std::size_t k = 0; k < objects.size(); ++k)
    if (const auto done = bus_.write(i, {mapping, static_cast<std::uint8_t>(k + 1)}, objects[k], 4); !done)
      return done;
  if (const auto done = write_checked(i, {mapping, 0}, static_cast<std::int64_t>(objects.size()), 1); !done)
    return done;
  return bus_.write(i, {parameters, 1}, used, 4);
}

CommandOutcome Cia402Drive::set_up(std::size_t i) {
  const Cia402AxisConfig& axis = axes_[i].config;
  if (const auto sent = bus_.send(nmt_frame(NmtCommand::pre_operational, bus_.node(i).number)); !sent)
    return sent;
  if (const auto done = bus_.pause(cia402_poll_interval); !done) return done;
  if (const auto done = identify(i); !done) return done;
  // What it said before it answered does not count any more.
  bus_.node(i).has_restarted = false;
  bus_.node(i).emergency = {};
  const auto units = [&](double microsteps) { return std::llround(microsteps * axis.position_unit); };
  const auto accelerations = [&](double value) { return std::llround(value * axis.acceleration_unit); };
  const auto [low, high] = std::minmax({units(axis.limits[0]), units(axis.limits[1])});
  if (const auto done = set_mode(i, 1); !done) return done;
  for (const auto& [object, value] : {std::pair<ObjectAddress, std::int64_t>{{0x607D, 1}, low},
                                      {{0x607D, 2}, high},
                                      {{0x6083, 0}, accelerations(axis.max_acceleration)},
                                      {{0x6084, 0}, accelerations(axis.max_acceleration)}})
    if (const auto done = write_checked(i, object, value, 4); !done) return done;
  // A quick stop must leave the motors on, so that the tendons keep their tension.
  if (const auto done = write_checked(i, {0x605A, 0}, 6, 2); !done) return done;
  if (const auto done = end_motion(i); !done) return done;
  if (const auto done = write_optional(i, {0x6085, 0}, accelerations(axis.stop_deceleration), 4); !done)
    return done;
  // Without heartbeats of the program, and in the NMT state "stopped": quick stop.
  if (const auto done = write_optional(i, {0x6007, 0}, 3, 2); !done) return done;
  const std::int64_t window = std::max(std::abs(units(config_.window)), 1LL);
  if (const auto done = write_optional(i, {0x6067, 0}, window, 4); !done) return done;
  if (const auto done = write_optional(i, {0x6086, 0}, 0, 2); !done) return done;
  if (axis.following_window > 0)
    if (const auto done = write_checked(i, {0x6065, 0}, std::abs(units(axis.following_window)), 4); !done)
      return done;
  if (const auto done = write_checked(i, {0x1017, 0}, std::llround(1000 * config_.heartbeat), 2); !done)
    return done;
  if (config_.host_timeout > 0) {
    const std::int64_t host = config_.host_node << 16 | std::llround(1000 * config_.host_timeout);
    if (const auto done = write_checked(i, {0x1016, 1}, host, 4); !done) return done;
  }
  if (const auto done = map_pdo(i, 0x1400, cob::rpdo1, 1, {0x60400010, 0x607A0020}); !done) return done;
  if (const auto done = map_pdo(i, 0x1401, cob::rpdo2, 1, {0x60810020}); !done) return done;
  return map_pdo(i, 0x1800, cob::tpdo1, 1, {0x60410010, 0x60640020});
}

CommandOutcome Cia402Drive::set_mode(std::size_t i, int mode) {
  if (const auto done = bus_.write(i, {0x6060, 0}, static_cast<std::uint32_t>(mode), 1); !done) return done;
  const double end = bus_.now() + config_.power_timeout;
  for (;;) {
    const auto shown = bus_.read(i, {0x6061, 0});
    if (!shown) return *shown.fault();
    if (static_cast<int>(shown.value().number() & 0xFF) == mode) return Accepted{};
    if (bus_.now() > end)
      return bus_.fault(i, FaultKind::refused,
                        fmt::format("does not change to mode {} (object 0x6060)", mode));
    if (const auto done = bus_.pause(cia402_poll_interval); !done) return done;
  }
}

CommandOutcome Cia402Drive::enable(bool resets_faults) {
  using enum DriveState;
  const double end = bus_.now() + config_.power_timeout;
  std::vector<int> stops(axes_.size());
  for (unsigned round = 0;; ++round) {
    if (const auto synchronised = synchronise(); !synchronised) return *synchronised.fault();
    std::optional<std::size_t> waiting;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const DriveState state = drive_state(bus_.node(i).statusword);
      if (state == fault && !resets_faults) return bus_.fault(i, FaultKind::refused, error_of(i));
      std::uint16_t word = control_word::enable;
      if (state == fault) word = round % 2 == 0 ? control_word::disable_voltage : control_word::fault_reset;
      if (state == switch_on_disabled) word = control_word::shutdown;
      if (state == ready_to_switch_on) word = control_word::switch_on;
      // Not every drive leaves a quick stop directly.
      if (state == quick_stop_active && ++stops[i] > 5) word = control_word::disable_voltage;
      if (state != operation_enabled) waiting = i;
      if (!axes_[i].has_target) axes_[i].target = bus_.node(i).position;
      if (const auto sent = send_word(i, word); !sent) return sent;
    }
    if (!waiting) return bus_.send(sync_frame());
    if (bus_.now() > end) {
      const DriveState state = drive_state(bus_.node(*waiting).statusword);
      if (state == fault || state == fault_reaction_active)
        return bus_.fault(*waiting, FaultKind::refused, error_of(*waiting));
      return bus_.fault(
          *waiting, FaultKind::refused,
          fmt::format("does not switch its motor on and stays in \"{}\" (statusword 0x{:04X}); check the "
                      "motor supply, the enable input and safe torque off",
                      name_of(state), bus_.node(*waiting).statusword));
    }
    if (const auto paused = bus_.pause(cia402_poll_interval); !paused) return paused;
  }
}

CommandOutcome Cia402Drive::release() {
  const unsigned halts = halts_;
  const std::scoped_lock lock(mutex_);
  if (const auto begun = begin(halts); !begun) return begun;
  const double end = bus_.now() + config_.power_timeout;
  for (;;) {
    std::optional<std::size_t> waiting;
    for (std::size_t i = 0; i < axes_.size(); ++i)
      if (const auto sent = send_word(i, control_word::disable_voltage); !sent) return sent;
    for (int k = 0; k < 2; ++k)
      if (const auto synchronised = synchronise(); !synchronised) return *synchronised.fault();
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const DriveState state = drive_state(bus_.node(i).statusword);
      if (state == DriveState::operation_enabled || state == DriveState::quick_stop_active) waiting = i;
    }
    if (!waiting) break;
    if (bus_.now() > end) return bus_.fault(*waiting, FaultKind::refused, "does not switch its motor off");
  }
  is_started_ = false;
  why_not_started_ = "the motors were switched off by release()";
  return Accepted{};
}

CommandOutcome Cia402Drive::home() {
  const unsigned halts = halts_;
  const std::scoped_lock lock(mutex_);
  if (const auto begun = begin(halts); !begun) return begun;
  if (const auto measured = measure(false); !measured) return *measured.fault();
  if (const auto enabled = enable(false); !enabled) return enabled;
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (axes_[i].config.homing_method != 0)
      // The drive may be left in homing mode, in which a target would start another homing.
      if (const auto done = home_axis(i); !done) return unusable(*done.fault());
  return Accepted{};
}

CommandOutcome Cia402Drive::home_axis(std::size_t i) {
  Axis& axis = axes_[i];
  axis.has_target = false;
  const auto units = [&](double rate) {
    return std::max(std::llround(rate * axis.config.velocity_unit), 1LL);
  };
  if (const auto done = set_mode(i, 6); !done) return done;
  for (const auto& [object, value, size] :
       {std::tuple<ObjectAddress, std::int64_t, int>{{0x6098, 0}, axis.config.homing_method, 1},
        {{0x6099, 1}, units(axis.config.homing_rates[0]), 4},
        {{0x6099, 2}, units(axis.config.homing_rates[1]), 4},
        {{0x607C, 0}, std::llround(axis.config.home * axis.config.position_unit), 4}})
    if (const auto done = write_checked(i, object, value, size); !done) return done;
  const auto acceleration = std::llround(axis.config.max_acceleration * axis.config.acceleration_unit);
  if (const auto done = write_optional(i, {0x609A, 0}, acceleration, 4); !done) return done;
  auto homed = run_homing(i);
  if (!homed) {
    // The axis may still move.
    (void)send_quick_stop();
    return homed;
  }
  if (const auto done = set_mode(i, 1); !done) return done;
  axis.last_position.reset();
  axis.target = bus_.node(i).position;
  return Accepted{};
}

CommandOutcome Cia402Drive::run_homing(std::size_t i) {
  const double end = bus_.now() + config_.homing_timeout;
  for (int round = 0;; ++round) {
    const std::uint16_t word = control_word::enable | (round > 0 ? control_word::start : 0);
    if (const auto sent = send_word(i, word); !sent) return sent;
    for (int k = 0; k < 2; ++k)
      if (const auto synchronised = synchronise(); !synchronised) return *synchronised.fault();
    const std::uint16_t status = bus_.node(i).statusword;
    if (drive_state(status) != DriveState::operation_enabled)
      return bus_.fault(i, FaultKind::refused, error_of(i));
    if ((status & status_bit::error) != 0)
      return bus_.fault(
          i, FaultKind::refused,
          fmt::format("cannot home by method {}; check the home switch", axes_[i].config.homing_method));
    const bool is_home =
        (status & status_bit::acknowledge) != 0 && (status & status_bit::target_reached) != 0;
    // A drive may show for a moment that it was home before.
    if (round > 1 && is_home) break;
    if (bus_.now() > end)
      return bus_.fault(
          i, FaultKind::refused,
          fmt::format("is not home after {:g} s; check the home switch", config_.homing_timeout));
    if (const auto paused = bus_.pause(0.01); !paused) return paused;
  }
  if (const auto sent = send_word(i, control_word::enable); !sent) return sent;
  for (int k = 0; k < 2; ++k)
    if (const auto synchronised = synchronise(); !synchronised) return *synchronised.fault();
  return Accepted{};
}

}  // namespace flexura
