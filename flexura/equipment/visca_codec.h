#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// Messages of the VISCA protocol for pan/tilt/zoom heads, as bytes. A packet is a byte with sender and
// receiver, a body, and the byte FF. Sources: docs/equipment/visca.md.
namespace flexura {

/// Framing of packets.
enum class ViscaFraming {
  stream,    ///< Packets follow each other in a stream, over a serial line or TCP.
  datagram,  ///< Each packet is one UDP datagram, without a header.
  sony,      ///< Each packet is in a UDP datagram, after a header of 8 bytes with a sequence number.
};
const std::vector<std::string>& names_of(const ViscaFraming*);

/// Size of the longest packet, bytes. The standard allows 16 bytes, but a move with 5 digits for each axis
/// needs 17.
inline constexpr std::size_t visca_longest = 17;
/// Address by which all devices of a chain are addressed.
inline constexpr int visca_everyone = 8;

/// Error codes of replies.
enum class ViscaError {
  length = 0x01,
  syntax = 0x02,
  buffer_full = 0x03,  ///< All command buffers (sockets) are in use.
  cancelled = 0x04,
  no_socket = 0x05,
  not_executable = 0x41,
};
/// Returns the meaning of an error, for example "syntax error", or "error 77h" for an unknown code. `code`:
/// the error byte.
[[nodiscard]] std::string visca_error_text(int code);

/// Splits a stream of bytes into packets.
class ViscaSplitter {
 public:
  /// Adds bytes. Returns the packets that are now complete, with their first and last byte. Discards packets
  /// that are too long, too short, or have an invalid first byte.
  std::vector<std::string> take(std::string_view bytes);
  /// Discards an incomplete packet.
  void reset() { part_.clear(), is_too_long_ = false; }

 private:
  std::string part_;
  bool is_too_long_ = false;
};

/// A datagram with a header of 8 bytes.
struct SonyMessage {
  /// The first two bytes.
  enum class Kind {
    command = 0x0100,
    inquiry = 0x0110,
    reply = 0x0111,
    setting = 0x0120,
    control = 0x0200,
    control_reply = 0x0201,
  };
  Kind kind = Kind::command;
  std::uint32_t sequence = 0;  ///< Sequence number of the request; a reply has the number of its request.
  std::string payload;         ///< A packet, or the content of a control message.
};
/// Returns the bytes of a datagram.
[[nodiscard]] std::string bytes_of(const SonyMessage& message);
/// Reads a datagram. Returns std::nullopt for an unknown kind or a payload of another length than stated.
[[nodiscard]] std::optional<SonyMessage> parse_sony(std::string_view datagram);
/// Payloads of control messages.
inline constexpr std::string_view sony_reset = "\x01", sony_bad_sequence = "\x0F\x01",
                                  sony_bad_kind = "\x0F\x02";

/// Number of digits of positions, 4 or 5 each.
struct ViscaDigits {
  int pan = 4, tilt = 4;
};

/// Returns the packet to the device `address`, 1 to 7, or visca_everyone.
[[nodiscard]] std::string visca_packet(int address, std::string_view body);

/// @{ The following functions return the bodies of commands and inquiries. Positions are in counts, speeds
/// from 0 to 24.
[[nodiscard]] std::string visca_move(int pan_speed, int tilt_speed, std::int64_t pan, std::int64_t tilt,
                                     ViscaDigits digits);
[[nodiscard]] std::string visca_move_stop(int pan_speed, int tilt_speed);
[[nodiscard]] std::string visca_zoom(std::int64_t count);
[[nodiscard]] std::string visca_zoom_stop();
[[nodiscard]] std::string visca_cancel(int socket);
[[nodiscard]] std::string visca_clear();
[[nodiscard]] std::string visca_set_addresses();
[[nodiscard]] std::string visca_ask_version();
[[nodiscard]] std::string visca_ask_move();
[[nodiscard]] std::string visca_ask_zoom();
/// @}

/// Message of a device.
struct ViscaReply {
  /// Kind of a reply. `ended`: a command is completed. `answer`: to an inquiry. `addresses`: to
  /// visca_set_addresses(). `cleared`: to visca_clear() for all devices. `chain_changed`: a device was added
  /// to the chain or removed.
  enum class Kind { accepted, ended, answer, error, addresses, cleared, chain_changed };
  Kind kind = Kind::accepted;
  int from = 0;      ///< Address of the device, 1 to 7.
  int socket = 0;    ///< Command buffer (socket) of the head, 0 to 15.
  int code = 0;      ///< For `error`: the error code. For `addresses`: the first free address, 2 to 8.
  std::string data;  ///< Data of an answer, 1 or more bytes.

  bool operator==(const ViscaReply&) const = default;
};
/// Parses a packet from a device. Returns std::nullopt if the bytes are not such a packet.
[[nodiscard]] std::optional<ViscaReply> parse_visca_reply(std::string_view packet);
/// Returns the packet of a reply.
[[nodiscard]] std::string bytes_of(const ViscaReply& reply);

/// Pan and tilt that a device reports, counts.
struct ViscaPlace {
  std::int64_t pan = 0, tilt = 0;
  bool operator==(const ViscaPlace&) const = default;
};
/// Reads the data of an answer to visca_ask_move(). Returns std::nullopt if the data does not have these
/// numbers of digits.
[[nodiscard]] std::optional<ViscaPlace> parse_visca_place(std::string_view data, ViscaDigits digits);
/// Reads the data of an answer to visca_ask_zoom(), counts.
[[nodiscard]] std::optional<std::int64_t> parse_visca_zoom(std::string_view data);
/// The following functions return the data of answers to visca_ask_move() and visca_ask_zoom().
[[nodiscard]] std::string visca_place_data(const ViscaPlace& place, ViscaDigits digits);
[[nodiscard]] std::string visca_zoom_data(std::int64_t count);

/// Answer to visca_ask_version().
struct ViscaVersion {
  int vendor = 0, model = 0, revision = 0, sockets = 2;
  bool operator==(const ViscaVersion&) const = default;
};
[[nodiscard]] std::optional<ViscaVersion> parse_visca_version(std::string_view data);
[[nodiscard]] std::string visca_version_data(const ViscaVersion& version);

/// Request of a controller, as parsed by a device.
struct ViscaRequest {
  /// Kind of a request. `drive`: pan and tilt in a direction, or stop. `unknown`: the device answers with a
  /// syntax error.
  enum class Kind {
    set_addresses,
    clear,
    cancel,
    ask_version,
    ask_move,
    ask_zoom,
    move,
    move_by,
    drive,
    home,
    zoom_to,
    zoom_drive,
    unknown,
  };
  Kind kind = Kind::unknown;
  int to = 1;         ///< Address, 1 to 8.
  int socket = 0;     ///< For a cancel: the command buffer (socket).
  int address = 0;    ///< Address in `set_addresses`.
  ViscaPlace place;   ///< For moves: counts. For `drive`: directions -1, 0 or 1 (right and up are 1).
  int pan_speed = 0;  ///< Speed byte of moves.
  int tilt_speed = 0;
  std::int64_t zoom = 0;  ///< Zoom, counts. For `zoom_drive`: direction -1, 0 or 1 (tele is 1).
};
/// Parses a packet from a controller. Returns std::nullopt if the packet is not addressed to devices.
[[nodiscard]] std::optional<ViscaRequest> parse_visca_request(std::string_view packet, ViscaDigits digits);

}  // namespace flexura
