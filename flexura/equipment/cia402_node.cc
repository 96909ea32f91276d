#include "flexura/equipment/cia402_node.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace flexura {

Cia402Node::Cia402Node(const Cia402NodeConfig& config)
    : config_(config),
      server_(
          config.node, [this](ObjectAddress object) { return read_object(object); },
          [this](ObjectAddress object, const std::string& bytes) { return write_object(object, bytes); }) {
  restart();
}

void Cia402Node::restart() {
  reset_objects();
  const double place = position(now_) - offset_;
  offset_ = config_.position - place;
  ramp_.set(now_, config_.position);
  stuck_at_.reset();
  waiting_[0].reset(), waiting_[1].reset();
  next_heartbeat_.reset(), host_heard_.reset(), next_target_.reset(), halted_target_.reset();
  nmt_ = NmtState::boot_up, state_ = DriveState::switch_on_disabled;
  word_ = error_ = 0;
  is_acknowledged_ = is_homing_ = is_homed_ = homing_failed_ = is_limited_ = has_target_ = false;
}

double Cia402Node::position(double now) const { return stuck_at_ ? *stuck_at_ : ramp_.position(now); }

double Cia402Node::velocity(double now) const { return stuck_at_ ? 0 : ramp_.velocity(now); }

double Cia402Node::rate(std::uint16_t index, std::uint8_t sub) const {
  return std::max(number(index, sub), 1);
}

std::uint16_t Cia402Node::statusword(double now) const {
  std::uint16_t word = statusword_of(state_) | (1U << 4U) | (1U << 9U);
  // Quick stop is active while bit 5 is 0; it means nothing in faults.
  const bool is_done = !ramp_.is_moving(now) && !is_homing_;
  const bool arrived = defect_ == Cia402Defect::lies || !stuck_at_ ||
                       std::abs(*stuck_at_ - ramp_.position(now)) <= rate(0x6067);
  if (is_done && arrived && (!has_target_ || !halted_target_)) word |= status_bit::target_reached;
  if (is_limited_) word |= status_bit::limit_active;
  if (number(0x6060) == static_cast<int>(Mode::homing)) {
    if (is_homed_) word |= status_bit::acknowledge;
    if (homing_failed_) word |= status_bit::error;
  } else {
    if (is_acknowledged_ || next_target_) word |= status_bit::acknowledge;
    if (error_ == 0x8611) word |= status_bit::error;
  }
  return word;
}

void Cia402Node::fail(std::uint16_t code, double now) {
  now_ = now;
  error_ = code;
  ramp_.stop(now, rate(0x6085));
  next_target_.reset(), halted_target_.reset();
  is_homing_ = is_acknowledged_ = false;
  state_ = DriveState::fault_reaction_active;
  send(emergency_frame(config_.node, {code, 1}));
}

void Cia402Node::set_defect(Cia402Defect defect, double now) {
  if (stuck_at_) ramp_.set(now, *stuck_at_);
  stuck_at_.reset();
  defect_ = defect;
  const bool stands = defect == Cia402Defect::ignores_targets || defect == Cia402Defect::lies ||
                      defect == Cia402Defect::blocked;
  if (stands) stuck_at_ = ramp_.position(now);
}

void Cia402Node::receive(const CanFrame& frame, double now, std::vector<CanFrame>& out) {
  advance(now, out);
  if (frame.is_error || frame.is_extended || frame.is_remote) return;
  if (frame.id == cob::nmt) {
    take_nmt(frame);
  } else if (frame.id == cob::sync) {
    if (nmt_ == NmtState::operational) take_sync();
  } else if (frame.id == cob::heartbeat + (value(0x1016, 1) >> 16U & 0x7F) &&
             (value(0x1016, 1) & 0xFFFF) != 0) {
    host_heard_ = now;
  } else if (frame.id == cob::sdo_request + config_.node && nmt_ != NmtState::stopped) {
    if (const auto answer = server_.answer(frame)) send(*answer);
  } else if (nmt_ == NmtState::operational) {
    take_pdo(frame);
  }
  advance(now, out);
}

void Cia402Node::advance(double now, std::vector<CanFrame>& out) {
  now_ = std::max(now, now_);
  if (nmt_ == NmtState::boot_up) {
    send(heartbeat_frame(config_.node, NmtState::boot_up));
    nmt_ = NmtState::pre_operational;
  }
  finish_motion();
  if (next_heartbeat_ && value(0x1017) > 0 && now_ >= *next_heartbeat_) {
    send(heartbeat_frame(config_.node, nmt_));
    next_heartbeat_ = now_ + 1e-3 * value(0x1017);
  }
  const double host_time = 1e-3 * (value(0x1016, 1) & 0xFFFF);
  if (host_heard_ && host_time > 0 && now_ > *host_heard_ + host_time) {
    host_heard_.reset();
    send(emergency_frame(config_.node, {0x8130, 0x10}));
    connection_lost();
  }
  out.insert(out.end(), outbox_.begin(), outbox_.end());
  outbox_.clear();
}

void Cia402Node::finish_motion() {
  const bool is_moving = ramp_.is_moving(now_);
  if (defect_ == Cia402Defect::blocked && state_ == DriveState::operation_enabled &&
      std::abs(ramp_.position(now_) - *stuck_at_) > rate(0x6065)) {
    fail(0x8611, now_);
    ramp_.set(now_, *stuck_at_);
    return;
  }
  if (is_moving) return;
  if (state_ == DriveState::fault_reaction_active) state_ = DriveState::fault;
  if (state_ == DriveState::quick_stop_active && number(0x605A) < 5)
    switch_off(DriveState::switch_on_disabled);
  if (is_homing_) {
    is_homing_ = false, is_homed_ = !stuck_at_, homing_failed_ = stuck_at_.has_value();
    if (is_homed_) {
      offset_ += number(0x607C) - ramp_.position(now_);
      ramp_.set(now_, number(0x607C));
    }
  }
  if (next_target_ && state_ == DriveState::operation_enabled)
    start_move(*std::exchange(next_target_, std::nullopt));
}

void Cia402Node::take_nmt(const CanFrame& frame) {
  if (frame.size < 2 || (frame.data[1] != 0 && frame.data[1] != config_.node)) return;
  switch (static_cast<NmtCommand>(frame.data[0])) {
    case NmtCommand::start:
      nmt_ = NmtState::operational;
      break;
    case NmtCommand::stop:
      if (nmt_ != NmtState::stopped) connection_lost();
      nmt_ = NmtState::stopped;
      break;
    case NmtCommand::pre_operational:
      nmt_ = NmtState::pre_operational;
      break;
    case NmtCommand::reset_node:
    case NmtCommand::reset_communication:
      restart();
      break;
  }
}

void Cia402Node::take_sync() {
  ++syncs_;
  // What is sent was sampled at the SYNC, before the targets that it starts.
  for (std::size_t i = 0; i < 2; ++i) {
    const auto parameters = static_cast<std::uint16_t>(0x1800 + i);
    const std::uint32_t type = value(parameters, 2);
    if ((value(parameters, 1) & 0x80000000) == 0 && type >= 1 && type <= 240 && syncs_ % type == 0)
      send(tpdo(i));
  }
  for (std::size_t i = 2; i-- > 0;)  // The controlword last.
    if (const auto frame = std::exchange(waiting_[i], std::nullopt))
      apply_pdo(*frame, static_cast<std::uint16_t>(0x1600 + i));
}

void Cia402Node::take_pdo(const CanFrame& frame) {
  for (std::size_t i = 0; i < 2; ++i) {
    const auto parameters = static_cast<std::uint16_t>(0x1400 + i);
    if (value(parameters, 1) != frame.id) continue;
    if (value(parameters, 2) <= 240) {
      waiting_[i] = frame;
    } else {
      apply_pdo(frame, static_cast<std::uint16_t>(0x1600 + i));
    }
  }
}

// The commands of CiA 402-2, from bits 0 to 3 and 7, in the states in which they have an effect.
void Cia402Node::step_state(std::uint16_t word) {
  using enum DriveState;
  const bool is_reset = (word & 0x80U) != 0 && (word_ & 0x80U) == 0;
  if (state_ == fault) {
    if (is_reset) {
      error_ = 0;
      send(emergency_frame(config_.node, {}));
      switch_off(switch_on_disabled);
    }
    return;
  }
  if (state_ == fault_reaction_active) return;
  if ((word & 0x02U) == 0) {
    switch_off(switch_on_disabled);
    return;
  }
  if ((word & 0x04U) == 0) {
    if (state_ == operation_enabled) {
      quick_stop();
    } else if (state_ != quick_stop_active) {
      switch_off(switch_on_disabled);
    }
    return;
  }
  const unsigned low = word & 0x0FU;
  if (low == 0x06 || low == 0x0E) {
    if (state_ == switch_on_disabled || state_ == switched_on || state_ == operation_enabled)
      switch_off(ready_to_switch_on);
  } else if (low == 0x07) {
    if (state_ == ready_to_switch_on || state_ == operation_enabled) switch_off(switched_on);
  } else if (low == 0x0F) {
    if (state_ == ready_to_switch_on) state_ = switched_on;
    const bool may = defect_ != Cia402Defect::refuses_power;
    if (may && (state_ == switched_on || state_ == quick_stop_active)) state_ = operation_enabled;
  }
}

void Cia402Node::switch_off(DriveState state) {
  ramp_.stop(now_, 1e12);
  next_target_.reset(), halted_target_.reset();
  is_homing_ = is_acknowledged_ = false;
  state_ = state;
}

void Cia402Node::quick_stop() {
  if (number(0x605A) == 0) {
    switch_off(DriveState::switch_on_disabled);
    return;
  }
  ramp_.stop(now_, rate(0x6085));
  next_target_.reset(), halted_target_.reset();
  is_homing_ = is_acknowledged_ = false;
  state_ = DriveState::quick_stop_active;
}

void Cia402Node::connection_lost() {
  const int option = number(0x6007);
  if (option == 1) fail(0x8130, now_);
  if (option == 2) switch_off(DriveState::switch_on_disabled);
  if (option == 3 && state_ == DriveState::operation_enabled) quick_stop();
}

void Cia402Node::take_controlword(std::uint16_t word) {
  finish_motion();
  step_state(word);
  if (state_ == DriveState::operation_enabled) {
    const bool is_new = (word & control_word::start) != 0 && (word_ & control_word::start) == 0;
    if (number(0x6060) == static_cast<int>(Mode::position)) {
      if ((word & control_word::halt) != 0 && (word_ & control_word::halt) == 0 && ramp_.is_moving(now_)) {
        halted_target_ = number(0x607A);
        ramp_.stop(now_, rate(0x6084));
      }
      if (is_new) take_setpoint(word);
      if ((word & control_word::halt) == 0 && halted_target_)
        start_move(*std::exchange(halted_target_, std::nullopt));
    } else if (number(0x6060) == static_cast<int>(Mode::homing) && is_new) {
      start_homing();
    }
  }
  if ((word & control_word::start) == 0) is_acknowledged_ = false;
  word_ = word;
}

void Cia402Node::take_setpoint(std::uint16_t word) {
  const double base = (word & control_word::relative) != 0 ? ramp_.position(now_) : 0;
  const double wanted = base + number(0x607A);
  const double low = number(0x607D, 1), high = number(0x607D, 2);
  const double target = low <= high ? std::clamp(wanted, low, high) : wanted;
  is_limited_ = target != wanted;
  if ((word & control_word::immediately) != 0 || !ramp_.is_moving(now_)) {
    next_target_.reset(), halted_target_.reset();
    start_move(target);
    is_acknowledged_ = true;
  } else if (!next_target_) {
    next_target_ = target;
  }
}

void Cia402Node::start_move(double target) {
  has_target_ = true;
  ramp_.move(now_, target, rate(0x6081), rate(0x6083), rate(0x6084));
}

void Cia402Node::start_homing() {
  const int method = number(0x6098);
  is_homed_ = homing_failed_ = false;
  if (method == 35 || method == 37) {
    offset_ += number(0x607C) - ramp_.position(now_);
    ramp_.set(now_, number(0x607C));
    is_homed_ = true;
  } else if (method == 0 || !config_.has_home_switch) {
    homing_failed_ = true;
  } else {
    is_homing_ = true;
    ramp_.move(now_, config_.home_switch + offset_, rate(0x6099, 1), rate(0x609A), rate(0x609A));
  }
}

}  // namespace flexura
