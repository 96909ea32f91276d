#include "flexura/equipment/visca_codec.h"

#include <fmt/format.h>

#include <algorithm>

namespace flexura {
namespace {

constexpr unsigned char visca_end = 0xFF;

unsigned byte_at(std::string_view bytes, std::size_t i) { return static_cast<unsigned char>(bytes[i]); }

std::string bytes_from(std::initializer_list<unsigned> values) {
  std::string bytes;
  for (const unsigned value : values) bytes.push_back(static_cast<char>(value));
  return bytes;
}

// Appends a number in two's complement, 4 bits in each byte.
void add_digits(std::string& bytes, std::int64_t value, int digits) {
  for (int i = digits - 1; i >= 0; --i)
    bytes.push_back(static_cast<char>((static_cast<std::uint64_t>(value) >> (4 * i)) & 0xF));
}

// Returns the unsigned number, or std::nullopt if a byte is not a digit.
std::optional<std::int64_t> number_of_digits(std::string_view bytes) {
  std::int64_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (byte_at(bytes, i) > 0xF) return std::nullopt;
    value = 16 * value + byte_at(bytes, i);
  }
  return value;
}

std::optional<std::int64_t> signed_number(std::string_view bytes) {
  std::optional<std::int64_t> value = number_of_digits(bytes);
  const std::int64_t range = std::int64_t{1} << (4 * bytes.size());
  if (value && *value >= range / 2) *value -= range;
  return value;
}

std::size_t size_of(int digits) { return static_cast<std::size_t>(digits); }

std::optional<SonyMessage::Kind> kind_of_sony(unsigned value) {
  using Kind = SonyMessage::Kind;
  for (const Kind kind :
       {Kind::command, Kind::inquiry, Kind::reply, Kind::setting, Kind::control, Kind::control_reply})
    if (static_cast<unsigned>(kind) == value) return kind;
  return std::nullopt;
}

// Returns the direction, or std::nullopt if the byte is not one of a drive. 3: stop.
std::optional<int> direction_of(unsigned value, unsigned negative, unsigned positive) {
  if (value == 3) return 0;
  if (value == positive) return 1;
  if (value == negative) return -1;
  return std::nullopt;
}

bool starts_with(std::string_view body, std::initializer_list<unsigned> values) {
  return body.starts_with(bytes_from(values));
}

void read_turn(std::string_view body, ViscaDigits digits, ViscaRequest& request) {
  using Kind = ViscaRequest::Kind;
  const std::size_t arguments = size_of(digits.pan) + size_of(digits.tilt);
  if ((starts_with(body, {0x01, 0x06, 0x02}) || starts_with(body, {0x01, 0x06, 0x03})) &&
      body.size() == 5 + arguments) {
    if (const auto place = parse_visca_place(body.substr(5), digits)) {
      request.kind = byte_at(body, 2) == 2 ? Kind::move : Kind::move_by;
      request.place = *place;
    }
  } else if (starts_with(body, {0x01, 0x06, 0x01}) && body.size() == 7) {
    const auto pan = direction_of(byte_at(body, 5), 1, 2), tilt = direction_of(byte_at(body, 6), 2, 1);
    if (pan && tilt) {
      request.kind = Kind::drive;
      request.place = {*pan, *tilt};
    }
  } else if (starts_with(body, {0x01, 0x06, 0x04}) && body.size() == 3) {
    request.kind = Kind::home;
    return;
  }
  if (request.kind == Kind::unknown) return;
  request.pan_speed = static_cast<int>(byte_at(body, 3));
  request.tilt_speed = static_cast<int>(byte_at(body, 4));
  constexpr int fastest = 0x18;
  if (request.pan_speed > fastest || request.tilt_speed > fastest) request.kind = Kind::unknown;
}

void read_zoom(std::string_view body, ViscaRequest& request) {
  using Kind = ViscaRequest::Kind;
  if (starts_with(body, {0x01, 0x04, 0x47}) && body.size() == 7) {
    if (const auto count = parse_visca_zoom(body.substr(3))) {
      request.kind = Kind::zoom_to;
      request.zoom = *count;
    }
  } else if (starts_with(body, {0x01, 0x04, 0x07}) && body.size() == 4) {
    const unsigned way = byte_at(body, 3);
    const bool is_tele = way == 2 || (way >= 0x20 && way <= 0x27);
    const bool is_wide = way == 3 || (way >= 0x30 && way <= 0x37);
    if (way != 0 && !is_tele && !is_wide) return;
    request.kind = Kind::zoom_drive;
    request.zoom = static_cast<int>(is_tele) - static_cast<int>(is_wide);
  }
}

}  // namespace

const std::vector<std::string>& names_of(const ViscaFraming*) {
  static const std::vector<std::string> names{"stream", "datagram", "sony"};
  return names;
}

std::string visca_error_text(int code) {
  switch (static_cast<ViscaError>(code)) {
    case ViscaError::length:
      return "wrong length";
    case ViscaError::syntax:
      return "syntax error";
    case ViscaError::buffer_full:
      return "buffer full";
    case ViscaError::cancelled:
      return "cancelled";
    case ViscaError::no_socket:
      return "no such socket";
    case ViscaError::not_executable:
      return "not executable";
  }
  return fmt::format("error {:02X}h", code);
}

std::vector<std::string> ViscaSplitter::take(std::string_view bytes) {
  std::vector<std::string> packets;
  for (const char byte : bytes) {
    if (part_.size() < visca_longest) {
      part_.push_back(byte);
    } else {
      is_too_long_ = true;
    }
    if (static_cast<unsigned char>(byte) != visca_end) continue;
    constexpr std::size_t shortest = 3;
    if (!is_too_long_ && part_.size() >= shortest && byte_at(part_, 0) >= 0x80) packets.push_back(part_);
    reset();
  }
  return packets;
}

std::string bytes_of(const SonyMessage& message) {
  const auto kind = static_cast<unsigned>(message.kind);
  const auto size = static_cast<unsigned>(message.payload.size());
  const std::uint32_t number = message.sequence;
  return bytes_from({kind >> 8, kind & 0xFF, size >> 8, size & 0xFF, number >> 24, (number >> 16) & 0xFF,
                     (number >> 8) & 0xFF, number & 0xFF}) +
         message.payload;
}

std::optional<SonyMessage> parse_sony(std::string_view datagram) {
  constexpr std::size_t header = 8;
  if (datagram.size() <= header || datagram.size() > header + visca_longest) return std::nullopt;
  const auto kind = kind_of_sony(256 * byte_at(datagram, 0) + byte_at(datagram, 1));
  const std::size_t size = std::size_t{256} * byte_at(datagram, 2) + byte_at(datagram, 3);
  if (!kind || size != datagram.size() - header) return std::nullopt;
  SonyMessage message{*kind, 0, std::string(datagram.substr(header))};
  for (std::size_t i = 4; i < header; ++i) message.sequence = 256 * message.sequence + byte_at(datagram, i);
  return message;
}

std::string visca_packet(int address, std::string_view body) {
  std::string packet = bytes_from({0x80U | static_cast<unsigned>(address)});
  packet += body;
  packet.push_back(static_cast<char>(visca_end));
  return packet;
}

std::string visca_move(int pan_speed, int tilt_speed, std::int64_t pan, std::int64_t tilt,
                       ViscaDigits digits) {
  return bytes_from({0x01, 0x06, 0x02, static_cast<unsigned>(pan_speed), static_cast<unsigned>(tilt_speed)}) +
         visca_place_data({pan, tilt}, digits);
}
std::string visca_move_stop(int pan_speed, int tilt_speed) {
  return bytes_from(
      {0x01, 0x06, 0x01, static_cast<unsigned>(pan_speed), static_cast<unsigned>(tilt_speed), 0x03, 0x03});
}
std::string visca_zoom(std::int64_t count) { return bytes_from({0x01, 0x04, 0x47}) + visca_zoom_data(count); }
std::string visca_zoom_stop() { return bytes_from({0x01, 0x04, 0x07, 0x00}); }
std::string visca_cancel(int socket) { return bytes_from({0x20U | static_cast<unsigned>(socket)}); }
std::string visca_clear() { return bytes_from({0x01, 0x00, 0x01}); }
std::string visca_set_addresses() { return bytes_from({0x30, 0x01}); }
std::string visca_ask_version() { return bytes_from({0x09, 0x00, 0x02}); }
std::string visca_ask_move() { return bytes_from({0x09, 0x06, 0x12}); }
std::string visca_ask_zoom() { return bytes_from({0x09, 0x04, 0x47}); }

std::optional<ViscaReply> parse_visca_reply(std::string_view packet) {
  using Kind = ViscaReply::Kind;
  if (packet.size() < 3 || packet.size() > visca_longest || byte_at(packet, packet.size() - 1) != visca_end)
    return std::nullopt;
  const unsigned first = byte_at(packet, 0), second = byte_at(packet, 1);
  const std::string_view data = packet.substr(2, packet.size() - 3);
  if (first == 0x88) {
    if (second == 0x30 && data.size() == 1 && byte_at(data, 0) >= 2 && byte_at(data, 0) <= 8)
      return ViscaReply{Kind::addresses, 0, 0, static_cast<int>(byte_at(data, 0)), {}};
    if (packet == visca_packet(visca_everyone, visca_clear())) return ViscaReply{Kind::cleared, 0, 0, 0, {}};
    return std::nullopt;
  }
  if (first < 0x90 || (first & 0xF) != 0) return std::nullopt;
  ViscaReply reply;
  reply.from = static_cast<int>(first >> 4) - 8;
  reply.socket = static_cast<int>(second & 0xF);
  if (second == 0x38 && data.empty()) {
    reply.kind = Kind::chain_changed, reply.socket = 0;
    return reply;
  }
  if (second >> 4 == 4 && data.empty()) return reply;
  if (second >> 4 == 5) {
    reply.kind = data.empty() ? Kind::ended : Kind::answer;
    reply.data = data;
    return reply;
  }
  if (second >> 4 == 6 && data.size() == 1) {
    reply.kind = Kind::error;
    reply.code = static_cast<int>(byte_at(data, 0));
    return reply;
  }
  return std::nullopt;
}

std::string bytes_of(const ViscaReply& reply) {
  using Kind = ViscaReply::Kind;
  const unsigned from = static_cast<unsigned>(reply.from + 8) << 4, end = visca_end;
  const auto socket = static_cast<unsigned>(reply.socket), code = static_cast<unsigned>(reply.code);
  switch (reply.kind) {
    case Kind::accepted:
      return bytes_from({from, 0x40 | socket, end});
    case Kind::ended:
    case Kind::answer:
      return bytes_from({from, 0x50 | socket}) + reply.data + bytes_from({end});
    case Kind::error:
      return bytes_from({from, 0x60 | socket, code, end});
    case Kind::addresses:
      return bytes_from({0x88, 0x30, code, end});
    case Kind::cleared:
      return visca_packet(visca_everyone, visca_clear());
    case Kind::chain_changed:
      return bytes_from({from, 0x38, end});
  }
  return {};
}

std::optional<ViscaPlace> parse_visca_place(std::string_view data, ViscaDigits digits) {
  if (data.size() != size_of(digits.pan) + size_of(digits.tilt)) return std::nullopt;
  const auto pan = signed_number(data.substr(0, size_of(digits.pan)));
  const auto tilt = signed_number(data.substr(size_of(digits.pan)));
  if (!pan || !tilt) return std::nullopt;
  return ViscaPlace{*pan, *tilt};
}

std::optional<std::int64_t> parse_visca_zoom(std::string_view data) {
  if (data.size() != 4) return std::nullopt;
  return number_of_digits(data);
}

std::string visca_place_data(const ViscaPlace& place, ViscaDigits digits) {
  std::string data;
  add_digits(data, place.pan, digits.pan);
  add_digits(data, place.tilt, digits.tilt);
  return data;
}

std::string visca_zoom_data(std::int64_t count) {
  std::string data;
  add_digits(data, count, 4);
  return data;
}

std::optional<ViscaVersion> parse_visca_version(std::string_view data) {
  constexpr std::size_t size = 7;
  if (data.size() != size) return std::nullopt;
  const auto word = [&](std::size_t i) {
    return static_cast<int>(256 * byte_at(data, i) + byte_at(data, i + 1));
  };
  return ViscaVersion{word(0), word(2), word(4), static_cast<int>(byte_at(data, 6))};
}

std::string visca_version_data(const ViscaVersion& version) {
  const auto high = [](int word) { return (static_cast<unsigned>(word) >> 8) & 0xFF; };
  const auto low = [](int word) { return static_cast<unsigned>(word) & 0xFF; };
  return bytes_from({high(version.vendor), low(version.vendor), high(version.model), low(version.model),
                     high(version.revision), low(version.revision), low(version.sockets)});
}

std::optional<ViscaRequest> parse_visca_request(std::string_view packet, ViscaDigits digits) {
  using Kind = ViscaRequest::Kind;
  if (packet.size() < 3 || packet.size() > visca_longest || byte_at(packet, packet.size() - 1) != visca_end)
    return std::nullopt;
  const unsigned first = byte_at(packet, 0);
  if (first < 0x81 || first > 0x88) return std::nullopt;
  ViscaRequest request;
  request.to = static_cast<int>(first & 0xF);
  const std::string_view body = packet.substr(1, packet.size() - 2);
  if (body.size() == 2 && byte_at(body, 0) == 0x30) {
    request.address = static_cast<int>(byte_at(body, 1));
    if (request.address >= 1 && request.address <= 7) request.kind = Kind::set_addresses;
  } else if (body.size() == 1 && byte_at(body, 0) >> 4 == 2) {
    request.kind = Kind::cancel;
    request.socket = static_cast<int>(byte_at(body, 0) & 0xF);
  } else if (body == visca_clear()) {
    request.kind = Kind::clear;
  } else if (body == visca_ask_version()) {
    request.kind = Kind::ask_version;
  } else if (body == visca_ask_move()) {
    request.kind = Kind::ask_move;
  } else if (body == visca_ask_zoom()) {
    request.kind = Kind::ask_zoom;
  } else {
    read_turn(body, digits, request);
    read_zoom(body, request);
  }
  return request;
}

}  // namespace flexura
