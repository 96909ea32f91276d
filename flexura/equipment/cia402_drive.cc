#include "flexura/equipment/cia402_drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace flexura {
namespace {

constexpr double confirmation = 0.002;  // s; a drive's status may be one of its cycles old.

Cia402Config checked_cia402(const Cia402Config& config) {
  if (const std::string problem = problem_of(config); !problem.empty())
    throw std::invalid_argument("cia402: " + problem);
  return config;
}

std::vector<std::uint8_t> node_numbers_of(const Cia402Config& config) {
  std::vector<std::uint8_t> numbers;
  std::ranges::transform(config.axes, std::back_inserter(numbers),
                         [](const Cia402AxisConfig& axis) { return static_cast<std::uint8_t>(axis.node); });
  return numbers;
}

CanFrame cia402_target_frame(std::uint8_t node, std::uint16_t word, std::int32_t target) {
  CanFrame frame{.id = cob::rpdo1 + node};
  append(frame, word, 2);
  append(frame, static_cast<std::uint32_t>(target), 4);
  return frame;
}

// Frames that make all drives stop quickly, whether their PDOs are set up or not.
std::vector<CanFrame> quick_stop_frames(const std::vector<std::uint8_t>& nodes, bool has_pdos) {
  std::vector<CanFrame> frames;
  for (const std::uint8_t node : nodes) {
    if (has_pdos) frames.push_back(cia402_target_frame(node, control_word::quick_stop, 0));
    frames.push_back(SdoTransfer::writing(node, {0x6040, 0}, control_word::quick_stop, 2).request());
  }
  if (has_pdos) frames.push_back(sync_frame());
  return frames;
}

}  // namespace

StopMessages cia402_stop(const Cia402Config& config, double delay) {
  const std::vector<std::uint8_t> nodes = node_numbers_of(checked_cia402(config));
  StopMessages stop;
  // A frame each by SDO and RPDO, SYNC, and the NMT command.
  const bool has_pdos = 2 * nodes.size() + 2 <= Guard::most_messages;
  std::ranges::transform(quick_stop_frames(nodes, has_pdos), std::back_inserter(stop.first), bytes_of);
  stop.delay = delay;
  stop.then = {bytes_of(nmt_frame(NmtCommand::stop, 0))};
  return stop;
}

Cia402Drive::Cia402Drive(Link& link, const ClockPort& clock, const Cia402Config& config)
    : config_(checked_cia402(config)),
      link_(link),
      bus_(link, clock, node_numbers_of(config), config.answer_timeout, static_cast<int>(config.tries)) {
  std::ranges::transform(config.axes, std::back_inserter(axes_), [](const Cia402AxisConfig& axis) {
    Axis made;
    made.config = axis;
    return made;
  });
  bus_.set_interrupt([this] { return !is_halting_ && halts_ != halts_seen_; });
}

void Cia402Drive::keep_alive() {
  if (config_.host_timeout > 0)
    (void)bus_.send(heartbeat_frame(static_cast<std::uint8_t>(config_.host_node), NmtState::operational));
}

std::vector<Cia402Identity> Cia402Drive::identities() const {
  const std::scoped_lock lock(mutex_);
  std::vector<Cia402Identity> identities;
  std::ranges::transform(axes_, std::back_inserter(identities), &Axis::identity);
  return identities;
}

PortFault Cia402Drive::unusable(const PortFault& fault) {
  is_started_ = false;
  why_not_started_ = fault.what;
  return fault;
}

CommandOutcome Cia402Drive::begin(unsigned halts) {
  if (halts_ != halts) return bus_.fault(FaultKind::refused, "halted before the command began");
  halts_seen_ = halts;
  if (!is_started_)
    return PortFault{FaultKind::refused, fmt::format("{}: the drives must be started (again): {}",
                                                     link_.name(), why_not_started_)};
  return Accepted{};
}

Outcome<double> Cia402Drive::synchronise() {
  keep_alive();
  auto time = bus_.synchronise();
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (bus_.node(i).has_restarted)
      return unusable(
          bus_.fault(i, FaultKind::refused,
                     "has restarted and has lost its set-up and perhaps its position; check its supply, "
                     "start the drives and home them again"));
  return time;
}

CommandOutcome Cia402Drive::send_word(std::size_t i, std::uint16_t word) {
  axes_[i].word = word;
  return bus_.send(cia402_target_frame(bus_.node(i).number, word, axes_[i].target));
}

double Cia402Drive::microsteps(std::size_t i, double units) const {
  return units / axes_[i].config.position_unit;
}

std::string Cia402Drive::error_of(std::size_t i) {
  std::uint16_t code = bus_.node(i).emergency.code;
  if (code == 0) {
    const auto error = bus_.run(i, SdoTransfer::reading(bus_.node(i).number, {0x603F, 0}), {0x603F, 0});
    if (error && error.value().abort_code() == 0) code = static_cast<std::uint16_t>(error.value().number());
  }
  return fmt::format("has a fault: {}; remove the cause and start the drives again", drive_error_text(code));
}

std::optional<Cia402Drive::Problem> Cia402Drive::problem_with(std::size_t i) {
  using enum DriveState;
  const std::uint16_t status = bus_.node(i).statusword;
  const DriveState state = drive_state(status);
  const auto problem = [&](const std::string& what, bool needs_start) {
    return Problem{bus_.fault(i, FaultKind::refused, what), needs_start};
  };
  if (state == fault || state == fault_reaction_active) return problem(error_of(i), true);
  if (state == quick_stop_active) {
    if (!axes_[i].has_target) return std::nullopt;
    return problem(
        "has made a quick stop that was not commanded here; check for an emergency stop, a limit switch "
        "or a missing heartbeat of the program",
        false);
  }
  if (state != operation_enabled)
    return problem(
        fmt::format("has switched its motor off (state \"{}\", statusword 0x{:04X}); check the motor supply "
                    "and safe torque off, and start the drives again",
                    name_of(state), status),
        true);
  if ((status & status_bit::error) != 0)
    return problem("cannot follow its target (following error); is it blocked, overloaded or too fast?",
                   false);
  return std::nullopt;
}

std::optional<Cia402Drive::Problem> Cia402Drive::doubt_about(std::size_t i, double now) const {
  const Axis& axis = axes_[i];
  const CanopenNode& node = bus_.node(i);
  const double position = microsteps(i, node.position), target = microsteps(i, axis.target);
  const auto problem = [&](const std::string& what, bool needs_start) {
    return Problem{bus_.fault(i, FaultKind::refused, what), needs_start};
  };
  if (axis.last_position) {
    const double before = microsteps(i, *axis.last_position);
    const double most =
        1.2 * axis.config.max_rate * (now - axis.last_time + config_.answer_timeout) + config_.window;
    if (std::abs(position - before) > most)
      return problem(
          fmt::format("has jumped from {:.0f} to {:.0f} microsteps, which its motor cannot do; start the "
                      "drives and home them again",
                      before, position),
          true);
  }
  if (!axis.has_target) return std::nullopt;
  const bool is_there =
      std::abs(position - target) <= std::max(config_.window, 1 / std::abs(axis.config.position_unit));
  if ((node.statusword & status_bit::target_reached) != 0) {
    if (is_there) return std::nullopt;
    const bool is_limited = (node.statusword & status_bit::limit_active) != 0;
    return problem(fmt::format("says that it has reached its target {:.0f} microsteps, but is at {:.0f}{}",
                               target, position, is_limited ? "; a limit of the drive is active" : ""),
                   false);
  }
  if (now > axis.ramp.end() + config_.settling && now > axis.progress_time + config_.settling)
    return problem(
        fmt::format("has accepted the target {:.0f} microsteps, but stands still at {:.0f}; is the motor "
                    "connected, and is the drive in the mode that its manual describes for CANopen?",
                    target, position),
        false);
  return std::nullopt;
}

Outcome<double> Cia402Drive::measure(bool checks_positions) {
  for (int i = 0;; ++i) {
    auto time = synchronise();
    if (!time) return time;
    std::optional<Problem> problem;
    for (std::size_t k = 0; k < axes_.size() && !problem; ++k) {
      problem = problem_with(k);
      if (!problem && checks_positions) problem = doubt_about(k, time.value());
    }
    if (!problem) {
      remember(time.value());
      return time;
    }
    // A status may be old, or a frame damaged. What is said again, counts.
    if (i >= std::max<int>(static_cast<int>(config_.tries), 2)) {
      for (std::size_t k = 0; k < axes_.size(); ++k) {
        axes_[k].has_target = false;
        if (drive_state(bus_.node(k).statusword) != DriveState::operation_enabled)
          axes_[k].ramp.stop(time.value(), axes_[k].config.stop_deceleration);
      }
      return problem->needs_start ? unusable(problem->fault) : problem->fault;
    }
    if (const auto paused = bus_.pause(confirmation); !paused) return *paused.fault();
  }
}

void Cia402Drive::remember(double now) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    const std::int32_t position = bus_.node(i).position;
    axis.last_position = position, axis.last_time = now;
    if (std::abs(microsteps(i, static_cast<double>(position) - axis.progress_position)) > config_.window)
      axis.progress_position = position, axis.progress_time = now;
  }
}

CommandOutcome Cia402Drive::command(std::span<const double> targets, double duration) {
  if (targets.size() != axes())
    return bus_.fault(FaultKind::refused, fmt::format("{} targets for {} axes", targets.size(), axes()));
  if (!std::ranges::all_of(targets, [](double target) { return std::isfinite(target); }))
    return bus_.fault(FaultKind::refused, "a target is not finite");
  const bool is_duration = duration >= 0 && std::isfinite(duration);
  if (!is_duration) return bus_.fault(FaultKind::refused, "a duration must be finite and not negative");
  const unsigned halts = halts_;
  const std::scoped_lock lock(mutex_);
  if (const auto begun = begin(halts); !begun) return begun;
  auto time = measure(false);
  if (!time) return *time.fault();
  const auto is_stopped = [&](std::size_t i) {
    return drive_state(bus_.node(i).statusword) == DriveState::quick_stop_active;
  };
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if (!is_stopped(i)) continue;
    if (const auto enabled = enable(false); !enabled) return enabled;
    time = measure(false);
    if (!time) return *time.fault();
    break;
  }
  if (const auto cleared = clear_acknowledgements(); !cleared) return cleared;
  if (const auto started = start_targets(targets, duration, time.value()); !started) return started;
  return accept_targets();
}

// A new setpoint is an edge of bit 4, so the previous one must be over.
CommandOutcome Cia402Drive::clear_acknowledgements() {
  for (std::int64_t tried = 0;; ++tried) {
    std::optional<std::size_t> waiting;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      if ((bus_.node(i).statusword & status_bit::acknowledge) == 0) continue;
      waiting = i;
      if (const auto sent = send_word(i, control_word::enable); !sent) return sent;
    }
    if (!waiting) return Accepted{};
    if (tried > 3 * config_.tries)
      return bus_.fault(*waiting, FaultKind::refused,
                        "keeps its acknowledgement of the previous target (bit 12 of 0x6041)");
    if (tried > 0)
      if (const auto paused = bus_.pause(confirmation); !paused) return paused;
    if (const auto time = synchronise(); !time) return *time.fault();
  }
}

CommandOutcome Cia402Drive::start_targets(std::span<const double> targets, double duration, double now) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    const Cia402AxisConfig& config = axis.config;
    const double target = std::clamp(targets[i], config.limits[0], config.limits[1]);
    axis.target = static_cast<std::int32_t>(
        std::clamp(std::round(target * config.position_unit), -2147483648.0, 2147483647.0));
    axis.has_target = true;
    const double position = microsteps(i, bus_.node(i).position), goal = microsteps(i, axis.target);
    const double velocity = axis.ramp.velocity(now);
    const double speed =
        cia402_speed(goal - position, velocity, duration, config.max_acceleration, config.max_rate);
    axis.ramp.set(now, position, velocity);
    axis.ramp.move(now, goal, speed, config.max_acceleration, config.max_acceleration);
    axis.progress_time = now, axis.progress_position = bus_.node(i).position;
    CanFrame frame{.id = cob::rpdo2 + bus_.node(i).number};
    append(frame, static_cast<std::uint32_t>(std::max(std::round(speed * config.velocity_unit), 1.0)), 4);
    // Nothing acknowledges a speed. Without it, the drive would move at the last speed.
    for (int copy = 0; copy < 2; ++copy)
      if (const auto sent = bus_.send(frame); !sent) return sent;
  }
  return Accepted{};
}

CommandOutcome Cia402Drive::accept_targets() {
  constexpr std::uint16_t word = control_word::enable | control_word::start | control_word::immediately;
  for (std::int64_t tried = 0;; ++tried) {
    std::optional<std::size_t> waiting;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      const bool has_accepted = tried > 0 && (bus_.node(i).statusword & status_bit::acknowledge) != 0;
      if (has_accepted) continue;
      waiting = i;
      // The first SYNC starts the motion; the answer to the second one shows it.
      if (tried == 1) continue;
      if (const auto sent = send_word(i, word); !sent) return sent;
    }
    if (!waiting) break;
    if (tried > 3 * config_.tries)
      return bus_.fault(
          *waiting, FaultKind::refused,
          fmt::format("does not accept the target {:.0f} microsteps (statusword 0x{:04X})",
                      microsteps(*waiting, axes_[*waiting].target), bus_.node(*waiting).statusword));
    if (tried > 1)
      if (const auto paused = bus_.pause(confirmation); !paused) return paused;
    if (const auto time = synchronise(); !time) return *time.fault();
  }
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (const auto sent = send_word(i, control_word::enable); !sent) return sent;
  return bus_.send(sync_frame());
}

CommandOutcome Cia402Drive::send_quick_stop() {
  CommandOutcome outcome = Accepted{};
  for (const CanFrame& frame : quick_stop_frames(node_numbers_of(config_), true))
    if (const auto sent = bus_.send(frame); !sent) outcome = sent;
  return outcome;
}

CommandOutcome Cia402Drive::halt() {
  ++halts_;
  CommandOutcome sent = send_quick_stop();
  // A command in progress ends now. It may have sent a target after the quick stop, hence another one.
  const std::scoped_lock lock(mutex_);
  halts_seen_ = halts_;
  for (Axis& axis : axes_) {
    axis.has_target = false;
    axis.ramp.stop(bus_.now(), axis.config.stop_deceleration);
  }
  if (!has_pdos_) return sent;
  is_halting_ = true;
  std::optional<PortFault> lost;
  for (std::int64_t tried = 0; tried <= 3 * config_.tries; ++tried) {
    (void)send_quick_stop();
    const auto time = synchronise();
    lost = time.fault();
    std::optional<std::size_t> moving;
    for (std::size_t i = 0; i < axes_.size(); ++i)
      if (drive_state(bus_.node(i).statusword) == DriveState::operation_enabled) moving = i;
    if (time && moving)
      lost = bus_.fault(*moving, FaultKind::refused, "does not make a quick stop; switch off its supply");
    if (!lost) break;
  }
  is_halting_ = false;
  // A drive may still hold a target, which the SYNC of the next reading would start.
  if (lost) return unusable(*lost);
  return Accepted{};
}

Outcome<DriveReading> Cia402Drive::read() {
  const unsigned halts = halts_;
  const std::scoped_lock lock(mutex_);
  if (const auto begun = begin(halts); !begun) return *begun.fault();
  const auto time = measure(true);
  if (!time) return *time.fault();
  DriveReading reading;
  reading.time = time.value();
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const bool is_there = (bus_.node(i).statusword & status_bit::target_reached) != 0;
    reading.values.push_back(microsteps(i, bus_.node(i).position));
    reading.moving =
        reading.moving || (axes_[i].has_target ? !is_there : axes_[i].ramp.is_moving(time.value()));
  }
  return reading;
}

}  // namespace flexura
