#include "flexura/equipment/sent_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "flexura/equipment/cia402_codec.h"
#include "flexura/equipment/grbl_codec.h"
#include "flexura/equipment/onvif_http.h"
#include "flexura/equipment/onvif_soap.h"

namespace flexura {
namespace {

std::string hex_of(std::string_view bytes, std::string_view between) {
  std::string text;
  for (const char byte : bytes)
    text += fmt::format("{}{:02X}", text.empty() ? "" : between, static_cast<unsigned char>(byte));
  return text;
}

std::optional<SentText> realtime_text(char byte) {
  switch (byte) {
    case grbl::ask_status:
      return SentText{"? (status)", true};
    case grbl::hold:
      return SentText{"! (hold)"};
    case grbl::resume:
      return SentText{"~ (resume)"};
    case grbl::reset:
      return SentText{"0x18 (reset)"};
    case grbl::cancel_jog:
      return SentText{"0x85 (cancel jog)"};
    default:
      return std::nullopt;
  }
}

std::string visca_meaning(const ViscaRequest& request) {
  using Kind = ViscaRequest::Kind;
  switch (request.kind) {
    case Kind::set_addresses:
      return "set addresses";
    case Kind::clear:
      return "clear buffers";
    case Kind::cancel:
      return fmt::format("cancel command {}", request.socket);
    case Kind::ask_version:
      return "version?";
    case Kind::ask_move:
      return "pan and tilt?";
    case Kind::ask_zoom:
      return "zoom?";
    case Kind::move:
      return fmt::format("pan to {}, tilt to {}, speeds {} and {}", request.place.pan, request.place.tilt,
                         request.pan_speed, request.tilt_speed);
    case Kind::move_by:
      return fmt::format("pan by {}, tilt by {}", request.place.pan, request.place.tilt);
    case Kind::drive:
      return request.place == ViscaPlace{} ? "stop pan and tilt" : "drive pan and tilt";
    case Kind::home:
      return "home";
    case Kind::zoom_to:
      return fmt::format("zoom to {}", request.zoom);
    case Kind::zoom_drive:
      return request.zoom == 0 ? "stop zoom" : "drive zoom";
    case Kind::unknown:
      break;
  }
  return "unknown";
}

bool is_question(ViscaRequest::Kind kind) {
  using Kind = ViscaRequest::Kind;
  return kind == Kind::ask_version || kind == Kind::ask_move || kind == Kind::ask_zoom;
}

ObjectAddress object_of(const CanFrame& frame) {
  return {static_cast<std::uint16_t>(number_at(frame, 1, 2)), static_cast<std::uint8_t>(frame.data[3])};
}

// What a request of the transfer protocol SDO does.
SentText sdo_text(const CanFrame& frame) {
  const unsigned command = frame.data[0], kind = command >> 5;
  if (command == 0x80) return {fmt::format("end the transfer of object {}", text(object_of(frame)))};
  if (kind == 2) return {fmt::format("object {}?", text(object_of(frame))), true};
  if (kind == 3) return {"next part?", true};
  if (kind != 1) return {"part of a transfer"};
  const int size = 4 - static_cast<int>(command >> 2 & 3);
  return {fmt::format("object {} = 0x{:0{}X}", text(object_of(frame)), number_at(frame, 4, size), 2 * size)};
}

std::string controlword_text(std::uint32_t word) {
  const std::uint32_t base = word & 0x000FU;
  std::string name = "enable";
  if ((word & control_word::fault_reset) != 0) {
    name = "reset fault";
  } else if (base == control_word::quick_stop) {
    name = "quick stop";
  } else if (base == control_word::shutdown) {
    name = "shut down";
  } else if (base == control_word::switch_on) {
    name = "switch on";
  } else if (base == control_word::disable_voltage) {
    name = "voltage off";
  }
  if ((word & control_word::start) != 0) name += ", start";
  return name;
}

std::string nmt_text(const CanFrame& frame) {
  static constexpr std::array<std::pair<NmtCommand, std::string_view>, 5> names{
      {{NmtCommand::start, "start"},
       {NmtCommand::stop, "stop"},
       {NmtCommand::pre_operational, "pre-operational"},
       {NmtCommand::reset_node, "reset"},
       {NmtCommand::reset_communication, "reset communication"}}};
  const auto* const found = std::ranges::find(names, static_cast<NmtCommand>(frame.data[0]),
                                              &std::pair<NmtCommand, std::string_view>::first);
  const std::string who = frame.data[1] == 0 ? "all nodes" : fmt::format("node {}", frame.data[1]);
  return fmt::format("{}: {}", who, found == names.end() ? "unknown command" : found->second);
}

SentText can_meaning(const CanFrame& frame) {
  const std::uint32_t node = frame.id & 0x7FU, base = frame.id & ~0x7FU;
  if (frame.id == cob::nmt) return {nmt_text(frame)};
  if (frame.id == cob::sync) return {"SYNC", true};
  if (base == cob::heartbeat) return {"heartbeat of this program", true};
  const auto of_node = [&](const SentText& said) {
    return SentText{fmt::format("node {}: {}", node, said.text), said.asks};
  };
  if (base == cob::sdo_request) return of_node(sdo_text(frame));
  if (base == cob::rpdo1)
    return of_node({fmt::format("{}, target {}", controlword_text(number_at(frame, 0, 2)),
                                static_cast<std::int32_t>(number_at(frame, 2, 4)))});
  if (base == cob::rpdo2) return of_node({fmt::format("speed {}", number_at(frame, 0, 4))});
  return {"unknown"};
}

}  // namespace

std::vector<SentText> grbl_sent(std::string_view bytes) {
  std::vector<SentText> sent;
  std::string line;
  for (const char byte : bytes) {
    if (auto one = realtime_text(byte)) {
      sent.push_back(std::move(*one));
    } else if (byte != '\n' && byte != '\r') {
      line += byte;
    } else if (!line.empty()) {
      const bool asks = line == "$I" || line == "$$" || line == "$G" || line == "$#" || line == "$";
      sent.push_back({std::exchange(line, {}), asks});
    }
  }
  if (!line.empty()) sent.push_back({line});
  return sent;
}

SentText visca_sent(std::string_view bytes, ViscaFraming framing, ViscaDigits digits) {
  std::string packet(bytes), number;
  if (framing == ViscaFraming::sony) {
    const auto message = parse_sony(bytes);
    if (!message) return {hex_of(bytes, " ") + "  unknown"};
    if (message->kind == SonyMessage::Kind::control) return {hex_of(bytes, " ") + "  reset numbers"};
    packet = message->payload;
    number = fmt::format(", number {}", message->sequence);
  }
  const auto request = parse_visca_request(packet, digits);
  if (!request) return {hex_of(bytes, " ") + "  unknown"};
  const std::string who = request->to == visca_everyone ? "all" : fmt::format("head {}", request->to);
  return {fmt::format("{}  {}{}: {}", hex_of(bytes, " "), who, number, visca_meaning(*request)),
          is_question(request->kind)};
}

SentText onvif_sent(std::string_view bytes) {
  HttpReader reader(HttpReader::Side::requests);
  reader.put(bytes);
  const std::optional<HttpMessage> message = reader.next();
  const auto request = message ? parse_onvif_request(message->body) : std::nullopt;
  if (!request) return {"unknown"};
  if (request->name.starts_with("Get")) return {request->name + "?", true};
  std::string text = request->name;
  const auto add = [&text](const char* name, const std::optional<double>& value) {
    if (value)
      text += fmt::format("{} {} {:.6g}", text.find(' ') == std::string::npos ? "" : ",", name, *value);
  };
  add("pan", request->pan), add("tilt", request->tilt), add("zoom", request->zoom);
  add("speed", request->speed);
  return {text};
}

SentText can_sent(std::string_view bytes) {
  const auto frame = parse_can_frame(bytes);
  if (!frame) return {hex_of(bytes, " ") + "  unknown"};
  const std::string data(reinterpret_cast<const char*>(frame->data.data()), frame->size);
  const SentText meaning = can_meaning(*frame);
  return {fmt::format("{:03X}#{:<16}  {}", frame->id, hex_of(data, ""), meaning.text), meaning.asks};
}

}  // namespace flexura
