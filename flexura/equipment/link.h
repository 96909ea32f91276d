#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "flexura/equipment/descriptor.h"
#include "flexura/port/outcome.h"

namespace flexura {

/// A connection to a device: a serial line, a TCP or UDP socket, or a CAN bus.
///
/// Several threads may use a link: one may read while others write. Bytes of one write are never mixed with
/// those of another.
class Link {
 public:
  virtual ~Link() = default;
  Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Returns the name for messages, for example "/dev/ttyUSB0".
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// Sends all bytes; over UDP, as one datagram; over CAN, they must be one frame (cia402_codec.h). Fails if
  /// the device does not take them within the link's write timeout.
  [[nodiscard]] virtual CommandOutcome write(std::string_view bytes) = 0;
  /// Waits until bytes arrive, for at most `timeout` s, >= 0. Returns what has arrived: at most 64 KiB, over
  /// UDP the next datagram, over CAN the next frame. Returns "" if nothing arrived.
  [[nodiscard]] virtual Outcome<std::string> read(double timeout) = 0;
  /// Returns the open file descriptor, or -1 if the link has none. It belongs to the link. The process that
  /// stops devices when this program dies (Guard) keeps a copy of it.
  [[nodiscard]] virtual int descriptor() const { return -1; }
};

/// Address of a device.
struct LinkAddress {
  /// Kind of a connection.
  enum class Kind { serial, tcp, udp, can };
  Kind kind = Kind::serial;
  std::string place;           ///< Path of the serial line, name or number of the host, or CAN interface.
  std::uint16_t port = 0;      ///< Port of the host.
  std::int64_t baud = 115200;  ///< Bits per second of a serial line.
};

/// Reads an address: "/dev/ttyUSB0" or "/dev/ttyUSB0@9600", "tcp:HOST:PORT", "udp:HOST:PORT", or
/// "can:INTERFACE" for an interface of SocketCAN. IPv6 numbers are in brackets. Throws std::invalid_argument
/// with a reason for any other text.
[[nodiscard]] LinkAddress parse_link_address(std::string_view text);
/// Returns the text of an address, which parse_link_address() reads.
[[nodiscard]] std::string text(const LinkAddress& address);

/// Opens a connection. A serial line is opened for this program alone, without flow control, with 8 data
/// bits, no parity and 1 stop bit. `write_timeout`: see Link::write(), s; a TCP connection must also be made
/// within this time. The speed of a CAN bus is a setting of its interface, not of the link. A CAN link also
/// receives the error frames of the interface.
[[nodiscard]] Outcome<std::unique_ptr<Link>> open_link(const LinkAddress& address, double write_timeout = 1);

/// Returns a link on an open descriptor, for example one end of a pair of sockets.
[[nodiscard]] std::unique_ptr<Link> adopt_link(Descriptor descriptor, std::string name,
                                               double write_timeout = 1);

/// Two ends of a serial line within this machine.
struct SerialPair {
  std::unique_ptr<Link> device;  ///< The end of a simulated device.
  std::string path;              ///< Path of the other end, for open_link().
  Descriptor kept;               ///< Keeps the other end in existence while no program has opened it.
};
/// Returns a pseudoterminal. Throws std::runtime_error if the system has none left.
[[nodiscard]] SerialPair open_serial_pair();

}  // namespace flexura
