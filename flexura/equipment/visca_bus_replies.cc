#include <algorithm>
#include <optional>
#include <string>

#include "flexura/equipment/visca_bus.h"

// Which request a reply belongs to. With Sony's header, the sequence number says it. Without it, a head
// answers in the order of requests, and a socket's number connects the end of a command to its acceptance.
namespace flexura {

template <class Property>
ViscaBus::Request* ViscaBus::find(Property has) {
  const auto found =
      std::ranges::find_if(requests_, [&](const RequestPtr& request) { return has(*request); });
  return found == requests_.end() ? nullptr : found->get();
}

void ViscaBus::take(std::string_view bytes) {
  if (bytes.empty()) return;
  if (framing_ == ViscaFraming::sony) {
    const auto message = parse_sony(bytes);
    if (!message) return;
    if (message->kind == SonyMessage::Kind::control_reply) take_control(*message);
    if (message->kind == SonyMessage::Kind::reply) take_packet(message->payload, message->sequence);
    return;
  }
  if (framing_ == ViscaFraming::datagram) splitter_.reset();
  for (const std::string& packet : splitter_.take(bytes)) take_packet(packet, std::nullopt);
}

void ViscaBus::take_control(const SonyMessage& message) {
  if (message.payload == sony_reset) {
    Request* request =
        find([](const Request& one) { return one.what == What::reset && one.state == State::waiting; });
    if (request != nullptr) request->state = State::ended;
    return;
  }
  Request* request = find([&](const Request& one) {
    return one.state == State::waiting && one.what != What::reset && one.sequence == message.sequence;
  });
  if (request == nullptr) return;
  if (message.payload == sony_bad_sequence) {
    // A repeated command is refused because the first one has arrived, and only its answer is lost.
    const bool is_done = request->tries > 1 && request->what != What::inquiry;
    request->state = is_done ? State::accepted : State::renumber;
  } else if (message.payload == sony_bad_kind) {
    request->state = State::refused;
    request->code = static_cast<int>(ViscaError::syntax);
  }
}

void ViscaBus::take_packet(std::string_view packet, std::optional<std::uint32_t> sequence) {
  using Kind = ViscaReply::Kind;
  const auto reply = parse_visca_reply(packet);
  if (!reply) return;
  const auto answer_all = [&](What what) {
    Request* request =
        find([&](const Request& one) { return one.what == what && one.state == State::waiting; });
    if (request != nullptr) request->state = State::ended, request->code = reply->code;
  };
  switch (reply->kind) {
    case Kind::accepted:
      take_accepted(*reply, sequence);
      return;
    case Kind::ended:
      take_ended(*reply, sequence);
      return;
    case Kind::answer:
      take_answer(*reply, sequence);
      return;
    case Kind::error:
      take_error(*reply, sequence);
      return;
    case Kind::addresses:
      answer_all(What::addresses);
      return;
    case Kind::cleared:
      answer_all(What::clear);
      return;
    case Kind::chain_changed:
      is_chain_changed_ = true;
      return;
  }
}

void ViscaBus::take_accepted(const ViscaReply& reply, std::optional<std::uint32_t> sequence) {
  Request* request = find([&](const Request& one) {
    return one.address == reply.from && one.what == What::command && one.state == State::waiting &&
           (!sequence || one.sequence == *sequence);
  });
  if (request == nullptr) return;
  // Whatever ran in this socket has ended, and that answer was lost.
  for (const RequestPtr& other : requests_)
    if (other->address == reply.from && other->state == State::accepted && other->socket == reply.socket)
      other->state = State::given_up;
  request->state = State::accepted;
  request->socket = reply.socket;
}

void ViscaBus::take_ended(const ViscaReply& reply, std::optional<std::uint32_t> sequence) {
  const auto is_command = [&](const Request& one) {
    return one.address == reply.from && one.what == What::command;
  };
  Request* request = nullptr;
  if (sequence) {
    request = find([&](const Request& one) {
      return is_command(one) && one.sequence == *sequence &&
             (one.state == State::accepted || one.state == State::waiting);
    });
  } else {
    if (reply.socket != 0)
      request = find([&](const Request& one) {
        return is_command(one) && one.state == State::accepted && one.socket == reply.socket;
      });
    // Some heads report the end alone.
    if (request == nullptr)
      request = find([&](const Request& one) { return is_command(one) && one.state == State::waiting; });
  }
  if (request != nullptr) request->state = State::ended;
}

void ViscaBus::take_answer(const ViscaReply& reply, std::optional<std::uint32_t> sequence) {
  Request* request = find([&](const Request& one) {
    return one.address == reply.from && one.what == What::inquiry && one.state == State::waiting &&
           (!sequence || one.sequence == *sequence);
  });
  if (request == nullptr) return;
  if (reply.data.size() != request->size) {
    request->other = reply.data.size();
    ++request->others;
    return;
  }
  request->data = reply.data;
  request->answered = now_();
  request->state = State::answered;
}

void ViscaBus::take_error(const ViscaReply& reply, std::optional<std::uint32_t> sequence) {
  const auto code = static_cast<ViscaError>(reply.code);
  // The answer to a cancel is the error that it causes. "No socket": there was nothing to cancel.
  if (code == ViscaError::cancelled || code == ViscaError::no_socket) {
    Request* cancel = find([&](const Request& one) {
      return one.address == reply.from && one.what == What::cancel && one.state == State::waiting &&
             (one.socket == reply.socket || code == ViscaError::no_socket);
    });
    if (cancel != nullptr) cancel->state = State::ended;
  }
  // A socket's number or a sequence number says which command it ended.
  Request* running = find([&](const Request& one) {
    return one.address == reply.from && one.what == What::command && one.state == State::accepted &&
           (sequence ? one.sequence == *sequence : reply.socket != 0 && one.socket == reply.socket);
  });
  // A full buffer is an answer to a new command, whatever the socket's number.
  if (running != nullptr && code != ViscaError::buffer_full) {
    running->state = State::failed;
    running->code = reply.code;
    return;
  }
  if (code == ViscaError::cancelled || code == ViscaError::no_socket) return;
  Request* request = find([&](const Request& one) {
    return one.address == reply.from && one.state == State::waiting &&
           (one.what == What::command || one.what == What::cancel ||
            // Inquiries need no buffer.
            (one.what == What::inquiry && code != ViscaError::buffer_full)) &&
           (!sequence || one.sequence == *sequence);
  });
  if (request == nullptr) return;
  request->state = State::refused;
  request->code = reply.code;
}

}  // namespace flexura
