#include "flexura/equipment/visca_device.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace flexura {

SteadyViscaMotors::SteadyViscaMotors(const std::array<double, 3>& rates, const ViscaCounts& start)
    : rates_(rates) {
  const std::array<std::int64_t, 3> counts{start.pan, start.tilt, start.zoom};
  for (std::size_t i = 0; i < counts.size(); ++i)
    motions_[i].from = motions_[i].to = static_cast<double>(counts[i]);
}

double SteadyViscaMotors::count(Axis axis, double now) {
  const Motion& motion = motions_[axis];
  const double way = motion.to - motion.from;
  const double done = motion.is_blocked ? 0 : motion.rate * std::max(now - motion.since, 0.0);
  return done >= std::abs(way) ? motion.to : motion.from + std::copysign(done, way);
}

bool SteadyViscaMotors::is_moving(Axis axis, double now) { return count(axis, now) != motions_[axis].to; }

void SteadyViscaMotors::go(Axis axis, double count, double speed, double now) {
  Motion& motion = motions_[axis];
  motion.from = this->count(axis, now), motion.to = count, motion.since = now;
  motion.rate = rates_[axis] * speed;
}

void SteadyViscaMotors::stop(Axis axis, double now) {
  Motion& motion = motions_[axis];
  motion.from = motion.to = std::round(count(axis, now));
}

void SteadyViscaMotors::block(Axis axis, bool is_blocked, double now) {
  Motion& motion = motions_[axis];
  motion.from = count(axis, now), motion.since = now, motion.is_blocked = is_blocked;
}

std::size_t ViscaDevice::add(const ViscaHeadModel& model, std::unique_ptr<ViscaMotors> motors) {
  constexpr std::size_t most = 7;
  if (heads_.size() == most || (framing_ != ViscaFraming::stream && !heads_.empty()))
    throw std::invalid_argument("a chain has at most 7 VISCA heads, a network address has one");
  if (!motors) motors = std::make_unique<SteadyViscaMotors>();
  heads_.push_back({model, std::move(motors), framing_ == ViscaFraming::stream ? 0 : 1, {}});
  return heads_.size() - 1;
}

ViscaCounts ViscaDevice::counts(std::size_t head, double now) {
  ViscaMotors& motors = *heads_[head].motors;
  return {std::llround(motors.count(ViscaMotors::pan, now)),
          std::llround(motors.count(ViscaMotors::tilt, now)),
          std::llround(motors.count(ViscaMotors::zoom, now))};
}

bool ViscaDevice::is_moving(std::size_t head, double now) {
  ViscaMotors& motors = *heads_[head].motors;
  return motors.is_moving(ViscaMotors::pan, now) || motors.is_moving(ViscaMotors::tilt, now) ||
         motors.is_moving(ViscaMotors::zoom, now);
}

std::vector<std::string> ViscaDevice::receive(std::string_view bytes, double now) {
  for (Head& head : heads_) end_finished(head, now);
  if (framing_ == ViscaFraming::sony) {
    take_sony(bytes, now);
  } else {
    if (framing_ == ViscaFraming::datagram) splitter_.reset();
    for (const std::string& packet : splitter_.take(bytes)) take_packet(packet, 0, now);
  }
  return advance(now);
}

std::vector<std::string> ViscaDevice::advance(double now) {
  for (Head& head : heads_) end_finished(head, now);
  std::vector<std::string> ready;
  const auto late =
      std::ranges::stable_partition(outgoing_, [&](const Outgoing& one) { return one.at <= now; });
  std::ranges::transform(outgoing_.begin(), late.begin(), std::back_inserter(ready),
                         [](Outgoing& one) { return std::move(one.bytes); });
  outgoing_.erase(outgoing_.begin(), late.begin());
  return ready;
}

void ViscaDevice::take_sony(std::string_view datagram, double now) {
  const auto message = parse_sony(datagram);
  if (!message || heads_.empty()) return;
  using Kind = SonyMessage::Kind;
  const double at = now + heads_.front().model.reply_delay;
  const auto control = [&](std::string_view payload) {
    outgoing_.push_back(
        {at, bytes_of(SonyMessage{Kind::control_reply, message->sequence, std::string(payload)})});
  };
  if (message->kind == Kind::control) {
    if (message->payload != sony_reset) return;
    last_sequence_.reset();
    control(sony_reset);
    return;
  }
  if (message->kind == Kind::reply || message->kind == Kind::control_reply) {
    control(sony_bad_kind);
    return;
  }
  // A number that is not newer than the last one is refused.
  constexpr std::uint32_t half = 0x80000000U;
  const std::uint32_t number = message->sequence;
  if (last_sequence_ && (number == *last_sequence_ || number - *last_sequence_ >= half)) {
    control(sony_bad_sequence);
    return;
  }
  last_sequence_ = number;
  take_packet(message->payload, number, now);
}

void ViscaDevice::take_packet(std::string_view packet, std::uint32_t sequence, double now) {
  for (Head& head : heads_) {
    const auto request = parse_visca_request(packet, head.model.digits);
    if (!request) return;
    if (request->to == visca_everyone) {
      take_broadcast(*request, now);
      return;
    }
    if (request->to == head.address) {
      take_request(head, *request, sequence, now);
      return;
    }
  }
}

void ViscaDevice::take_broadcast(const ViscaRequest& request, double now) {
  using Kind = ViscaReply::Kind;
  // A broadcast passes through all heads, and the last one sends it back.
  const double at = now + heads_.back().model.reply_delay;
  if (request.kind == ViscaRequest::Kind::set_addresses && framing_ == ViscaFraming::stream) {
    int address = request.address;
    for (Head& head : heads_) head.address = address <= 7 ? address++ : 0;
    send(bytes_of(ViscaReply{Kind::addresses, 0, 0, address, {}}), 0, at);
  } else if (request.kind == ViscaRequest::Kind::clear) {
    for (Head& head : heads_) {
      head.running.clear();
      stop(head, false, now), stop(head, true, now);
    }
    send(bytes_of(ViscaReply{Kind::cleared, 0, 0, 0, {}}), 0, at);
  }
}

void ViscaDevice::answer(const Head& head, ViscaReply reply, std::uint32_t sequence, double now) {
  if (reply.kind == ViscaReply::Kind::accepted && !head.model.reports_acceptance) return;
  if (reply.kind == ViscaReply::Kind::ended && !head.model.reports_end && reply.socket != 0) return;
  reply.from = head.address;
  if (head.address != 0) send(bytes_of(reply), sequence, now + head.model.reply_delay);
}

void ViscaDevice::send(std::string packet, std::uint32_t sequence, double at) {
  if (framing_ == ViscaFraming::sony)
    packet = bytes_of(SonyMessage{SonyMessage::Kind::reply, sequence, std::move(packet)});
  outgoing_.push_back({at, std::move(packet)});
}

void ViscaDevice::take_request(Head& head, const ViscaRequest& request, std::uint32_t sequence, double now) {
  using Asked = ViscaRequest::Kind;
  using Kind = ViscaReply::Kind;
  const auto say = [&](ViscaReply reply) { answer(head, std::move(reply), sequence, now); };
  const auto refuse = [&](ViscaError code) { say({Kind::error, 0, 0, static_cast<int>(code), {}}); };
  ViscaMotors& motors = *head.motors;
  switch (request.kind) {
    case Asked::ask_version:
      say({Kind::answer, 0, 0, 0, visca_version_data(head.model.version)});
      return;
    case Asked::ask_move: {
      const ViscaPlace place{std::llround(motors.count(ViscaMotors::pan, now)),
                             std::llround(motors.count(ViscaMotors::tilt, now))};
      say({Kind::answer, 0, 0, 0, visca_place_data(place, head.model.digits)});
      return;
    }
    case Asked::ask_zoom:
      say({Kind::answer, 0, 0, 0, visca_zoom_data(std::llround(motors.count(ViscaMotors::zoom, now)))});
      return;
    case Asked::clear:
      head.running.clear();
      stop(head, false, now), stop(head, true, now);
      say({Kind::ended, 0, 0, 0, {}});
      return;
    case Asked::cancel:
      cancel(head, request.socket, sequence, now);
      return;
    case Asked::set_addresses:
    case Asked::unknown:
      refuse(ViscaError::syntax);
      return;
    default:
      execute(head, request, sequence, now);
      return;
  }
}

void ViscaDevice::execute(Head& head, const ViscaRequest& request, std::uint32_t sequence, double now) {
  using Asked = ViscaRequest::Kind;
  using Kind = ViscaReply::Kind;
  const auto refuse = [&](ViscaError code) {
    answer(head, {Kind::error, 0, 0, static_cast<int>(code), {}}, sequence, now);
  };
  const bool is_zoom = request.kind == Asked::zoom_to || request.kind == Asked::zoom_drive;
  const bool is_stop = (request.kind == Asked::drive && request.place == ViscaPlace{}) ||
                       (request.kind == Asked::zoom_drive && request.zoom == 0);
  if (!head.model.is_on) {
    refuse(ViscaError::not_executable);
    return;
  }
  int socket = 1;
  while (std::ranges::find(head.running, socket, &Running::socket) != head.running.end()) ++socket;
  if (socket > head.model.version.sockets) {
    refuse(ViscaError::buffer_full);
    return;
  }
  const auto same = [&](const Running& one) { return one.is_zoom == is_zoom; };
  const bool overlaps = std::ranges::any_of(head.running, same);
  if (overlaps && !is_stop && head.model.overlap == ViscaHeadModel::Overlap::is_refused) {
    refuse(ViscaError::not_executable);
    return;
  }
  answer(head, {Kind::accepted, 0, socket, 0, {}}, sequence, now);
  if (is_stop) {
    stop(head, is_zoom, now);
    end_finished(head, now);
    answer(head, {Kind::ended, 0, socket, 0, {}}, sequence, now);
    return;
  }
  ++moves_;
  if (head.model.obeys) start(head, request, now);
  // A replaced move ends when the new one does.
  head.running.push_back({socket, is_zoom, sequence});
}

void ViscaDevice::start(Head& head, const ViscaRequest& request, double now) {
  using Asked = ViscaRequest::Kind;
  ViscaMotors& motors = *head.motors;
  const ViscaCounts &low = head.model.lowest, &high = head.model.highest;
  constexpr double fastest = 24;
  const auto share = [&](int speed) { return std::max(speed, 1) / fastest; };
  const auto go = [&](ViscaMotors::Axis axis, std::int64_t to, std::int64_t least, std::int64_t most,
                      double speed) {
    motors.go(axis, static_cast<double>(std::clamp(to, least, most)), speed, now);
  };
  const auto turn = [&](std::int64_t pan, std::int64_t tilt, double pan_speed, double tilt_speed) {
    go(ViscaMotors::pan, pan, low.pan, high.pan, pan_speed);
    go(ViscaMotors::tilt, tilt, low.tilt, high.tilt, tilt_speed);
  };
  const double pan_speed = share(request.pan_speed);
  // Speed 0 of the tilt axis: that of the pan axis.
  const double tilt_speed = request.tilt_speed == 0 ? pan_speed : share(request.tilt_speed);
  const ViscaPlace here{std::llround(motors.count(ViscaMotors::pan, now)),
                        std::llround(motors.count(ViscaMotors::tilt, now))};
  const auto end_of = [](std::int64_t way, std::int64_t at, std::int64_t least, std::int64_t most) {
    if (way == 0) return at;
    return way < 0 ? least : most;
  };
  switch (request.kind) {
    case Asked::move:
      turn(request.place.pan, request.place.tilt, pan_speed, tilt_speed);
      return;
    case Asked::move_by:
      turn(here.pan + request.place.pan, here.tilt + request.place.tilt, pan_speed, tilt_speed);
      return;
    case Asked::drive:
      turn(end_of(request.place.pan, here.pan, low.pan, high.pan),
           end_of(request.place.tilt, here.tilt, low.tilt, high.tilt), pan_speed, tilt_speed);
      return;
    case Asked::home:
      turn(0, 0, 1, 1);
      return;
    case Asked::zoom_to:
      go(ViscaMotors::zoom, request.zoom, low.zoom, high.zoom, 1);
      return;
    case Asked::zoom_drive:
      go(ViscaMotors::zoom, end_of(request.zoom, 0, low.zoom, high.zoom), low.zoom, high.zoom, 1);
      return;
    default:
      return;
  }
}

void ViscaDevice::cancel(Head& head, int socket, std::uint32_t sequence, double now) {
  using Kind = ViscaReply::Kind;
  const auto found = std::ranges::find(head.running, socket, &Running::socket);
  const bool is_running = found != head.running.end();
  if (is_running) {
    const bool is_zoom = found->is_zoom;
    head.running.erase(found);
    stop(head, is_zoom, now);
  }
  const ViscaError code = is_running ? ViscaError::cancelled : ViscaError::no_socket;
  answer(head, {Kind::error, 0, socket, static_cast<int>(code), {}}, sequence, now);
}

void ViscaDevice::stop(Head& head, bool is_zoom, double now) {
  if (!head.model.obeys) return;
  if (is_zoom) {
    head.motors->stop(ViscaMotors::zoom, now);
    return;
  }
  head.motors->stop(ViscaMotors::pan, now);
  head.motors->stop(ViscaMotors::tilt, now);
}

void ViscaDevice::end_finished(Head& head, double now) {
  ViscaMotors& motors = *head.motors;
  const bool turns = motors.is_moving(ViscaMotors::pan, now) || motors.is_moving(ViscaMotors::tilt, now);
  const bool zooms = motors.is_moving(ViscaMotors::zoom, now);
  std::erase_if(head.running, [&](const Running& one) {
    if (one.is_zoom ? zooms : turns) return false;
    answer(head, {ViscaReply::Kind::ended, 0, one.socket, 0, {}}, one.sequence, now);
    return true;
  });
}

void ViscaDevice::fail(std::size_t head, ViscaError code, double now) {
  Head& one = heads_[head];
  for (const Running& command : one.running)
    answer(one, {ViscaReply::Kind::error, 0, command.socket, static_cast<int>(code), {}}, command.sequence,
           now);
  one.running.clear();
  stop(one, false, now), stop(one, true, now);
}

void ViscaDevice::restart(double now) {
  last_sequence_.reset();
  outgoing_.clear();
  splitter_.reset();
  for (Head& head : heads_) {
    stop(head, false, now), stop(head, true, now);
    head.running.clear();
    // A head of a chain that was added has no address and says so.
    if (framing_ == ViscaFraming::stream) {
      head.address = 1;
      answer(head, {ViscaReply::Kind::chain_changed, 0, 0, 0, {}}, 0, now);
      head.address = 0;
    }
  }
}

}  // namespace flexura
