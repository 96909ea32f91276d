#pragma once

#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>

#include "flexura/equipment/guard.h"

// What the process that protects devices (Guard) is sent, and what it does.
namespace flexura {

/// A message to the guarding process. It may carry a descriptor.
struct GuardMessage {
  /// Kinds of messages.
  enum class Kind : std::uint8_t {
    protect,  ///< Protect a device; carries its link, or has its address.
    renew,    ///< Replace the messages of device number `device`.
    moving,   ///< The next beat is due within a period.
    resting,  ///< No beat is due.
    stop,     ///< Stop all devices now.
    end,      ///< End without a stop.
  };
  Kind kind = Kind::resting;
  std::uint8_t first = 0;  ///< Number of messages that are sent at once.
  std::uint8_t count = 0;  ///< Number of all messages.
  double delay = 0;        ///< From the first messages to the others, s.
  std::array<std::uint16_t, Guard::most_messages> sizes{};
  std::array<char, Guard::messages_size> text{};  ///< One message after the other.
  std::uint8_t device = 0;
  socklen_t address_size = 0;  ///< 0: the device has a link.
  sockaddr_storage address{};
};

/// Answers of the guarding process.
enum class GuardAnswer : char { ready = 'r', stopped = 's' };

/// Sends `size` bytes over a link at once. Discards what a serial line has not sent yet, because a stop must
/// not wait behind commands. Tries for a short time only. Async-signal-safe.
void send_stop(int descriptor, const char* bytes, std::size_t size) noexcept;

/// Protects devices until `socket` says that it need not. Allocates no memory and uses only async-signal-safe
/// functions, because it runs in a copy of a process that may have had several threads. Returns after a stop
/// of all devices if the other side of `socket` is gone.
void guard_devices(int socket, double period) noexcept;

}  // namespace flexura
