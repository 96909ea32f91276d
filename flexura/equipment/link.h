#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "flexura/base/descriptor.h"
#include "flexura/port/outcome.h"

namespace flexura {

/// A connection to a device: a serial line, a TCP or UDP socket, or a CAN bus.
///
/// Several threads may use a link: one may read while others write. Bytes of one write are never mixed with
/// the bytes of another write.
class Link {
 public:
  virtual ~Link() = default;
  Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Returns the name for messages, for example "/dev/ttyUSB0".
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// Sends all bytes. Over UDP the bytes are one datagram; over CAN the bytes must be one frame
  /// (cia402_codec.h). Fails if the bytes cannot be sent within the link's write timeout.
  [[nodiscard]] virtual CommandOutcome write(std::string_view bytes) = 0;
  /// Waits until bytes arrive, for at most `timeout` s, >= 0. Returns what has arrived: at most 64 KiB, over
  /// UDP the next datagram, over CAN the next frame. Returns "" if nothing arrived.
  [[nodiscard]] virtual Outcome<std::string> read(double timeout) = 0;
  /// Returns the open file descriptor, which the link owns; -1 if the link has none. Guard passes a copy of
  /// the descriptor to the process that stops devices when this program crashes.
  [[nodiscard]] virtual int descriptor() const { return -1; }
};

/// Address of a device.
struct LinkAddress {
  /// Kind of a connection.
  enum class Kind { serial, tcp, udp, can };
  Kind kind = Kind::serial;
  std::string
      place;  ///< Path of the serial line, name or IP address of the host, or name of the CAN interface.
  std::uint16_t port = 0;      ///< Port of the host.
  std::int64_t baud = 115200;  ///< Bits per second of a serial line.
};

/// Parses an address: "/dev/ttyUSB0" or "/dev/ttyUSB0@9600", "tcp:HOST:PORT", "udp:HOST:PORT", or
/// "can:INTERFACE" for an interface of SocketCAN. IPv6 addresses are in brackets. Throws
/// std::invalid_argument with a reason for any other text.
[[nodiscard]] LinkAddress parse_link_address(std::string_view text);
/// Returns the text of an address, which parse_link_address() reads.
[[nodiscard]] std::string text(const LinkAddress& address);

/// Opens a connection. A serial line is opened exclusively, without flow control, with 8 data bits, no parity
/// and 1 stop bit. `write_timeout`, s: longest duration of Link::write(), and of connecting over TCP. The bit
/// rate of a CAN bus is a setting of its interface, not of the link. A CAN link also receives the error
/// frames of the interface.
[[nodiscard]] Outcome<std::unique_ptr<Link>> open_link(const LinkAddress& address, double write_timeout = 1);

/// Returns a link that uses an open descriptor, for example one end of a socket pair.
[[nodiscard]] std::unique_ptr<Link> adopt_link(Descriptor descriptor, std::string name,
                                               double write_timeout = 1);

/// The two ends of a virtual serial line on this computer (pseudoterminal).
struct SerialPair {
  std::unique_ptr<Link> device;  ///< The end for a simulated device.
  std::string path;              ///< Path of the other end, for open_link().
  Descriptor kept;               ///< Keeps the other end open while no program uses it.
};
/// Returns a pseudoterminal. Throws std::runtime_error if the system has no free pseudoterminal.
[[nodiscard]] SerialPair open_serial_pair();

}  // namespace flexura
