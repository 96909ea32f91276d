#pragma once

#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

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

/// Returns the message that protects a device with these stop messages. Throws std::invalid_argument, naming
/// the device, if there are too many messages, they are too long, or their delay is invalid.
[[nodiscard]] GuardMessage guard_message(const StopMessages& stop, const std::string& name);

/// Answers of the guarding process.
enum class GuardAnswer : char { ready = 'r', stopped = 's' };

/// Decides when which stop messages are sent. Has neither clock nor sockets, so that it also runs in
/// simulated time. Allocates no memory.
class GuardWatch {
 public:
  /// `period`: see Guard, s.
  explicit GuardWatch(double period) noexcept : period_(period) {}
  virtual ~GuardWatch() = default;
  GuardWatch(const GuardWatch&) = delete;
  GuardWatch& operator=(const GuardWatch&) = delete;

  /// Takes a message of the program at time `now`, s. `link`: the link that it carries, or -1.
  void heed(const GuardMessage& message, int link, double now) noexcept;
  /// Stops all devices, because the program has ended without a message.
  void lose_program(double now) noexcept;
  /// Sends what is due at time `now`, s. Returns whether it has stopped the devices because the program is
  /// silent.
  bool advance(double now) noexcept;
  /// Returns the time at which something is due unless the program says more, s; HUGE_VAL: never.
  [[nodiscard]] double due() const noexcept;
  /// Returns whether the program has ended.
  [[nodiscard]] bool is_over() const noexcept { return is_over_; }

 protected:
  /// Sends bytes over a link at once.
  virtual void send(int link, const char* bytes, std::size_t size) noexcept = 0;
  /// Begins to send the first messages of a device at an address, over a new connection. `device`: its
  /// number.
  virtual void send_to_address(std::size_t device, const GuardMessage& stop) noexcept = 0;

 private:
  struct Device {
    int link = -1;
    GuardMessage stop;
  };
  void stop(double now) noexcept;
  void send_rest(double now) noexcept;
  void send_part(std::size_t i, std::size_t from, std::size_t to) noexcept;

  double period_;
  std::array<Device, Guard::most_links> device_{};
  std::array<bool, Guard::most_links> is_rest_due_{};
  std::size_t devices_ = 0;
  bool is_moving_ = false, is_over_ = false, has_rest_ = false;
  double beat_ = 0, stopped_ = 0;
};

/// Sends `size` bytes over a link at once. Discards what a serial line has not sent yet, because a stop must
/// not wait behind commands. Tries for a short time only. Async-signal-safe.
void send_stop(int descriptor, const char* bytes, std::size_t size) noexcept;

/// Protects devices until `socket` says that it need not. Allocates no memory and uses only async-signal-safe
/// functions, because it runs in a copy of a process that may have had several threads. Returns after a stop
/// of all devices if the other side of `socket` is gone.
void guard_devices(int socket, double period) noexcept;

}  // namespace flexura
