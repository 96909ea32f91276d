#pragma once

#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "flexura/equipment/guard.h"

// What the process that protects devices (Guard) is sent, and what it does.
namespace flexura {

/// A message to the guarding process. Some messages carry a file descriptor.
struct GuardMessage {
  /// Kinds of messages.
  enum class Kind : std::uint8_t {
    protect,  ///< Protect a device. The message carries the descriptor of its link, or contains its address.
    renew,    ///< Replace the stop messages of device number `device`.
    moving,   ///< The next beat must follow within a period.
    resting,  ///< No further beat is needed.
    stop,     ///< Stop all devices now.
    end,      ///< End without stopping the devices.
  };
  Kind kind = Kind::resting;
  std::uint8_t first = 0;  ///< Number of stop messages that are sent immediately.
  std::uint8_t count = 0;  ///< Number of all stop messages.
  double delay = 0;        ///< Delay from the first messages to the others, s.
  std::array<std::uint16_t, Guard::most_messages> sizes{};
  std::array<char, Guard::messages_size> text{};  ///< Texts of all messages, one after the other.
  std::uint8_t device = 0;
  socklen_t address_size = 0;  ///< Size of `address`; 0: the message carries a link.
  sockaddr_storage address{};
};

/// Returns the message that protects a device with these stop messages. Throws std::invalid_argument, naming
/// the device, if there are too many messages, they are too long, or their delay is invalid.
[[nodiscard]] GuardMessage guard_message(const StopMessages& stop, const std::string& name);

/// Answers of the guarding process.
enum class GuardAnswer : char { ready = 'r', stopped = 's' };

/// Decides which stop messages are sent at which time. A GuardWatch has neither a clock nor sockets, so that
/// tests can run a GuardWatch in simulated time. Allocates no memory.
class GuardWatch {
 public:
  /// `period`: longest time between beats while the arm moves, s.
  explicit GuardWatch(double period) noexcept : period_(period) {}
  virtual ~GuardWatch() = default;
  GuardWatch(const GuardWatch&) = delete;
  GuardWatch& operator=(const GuardWatch&) = delete;

  /// Processes a message of the program at time `now`, s. `link`: descriptor of the link that the message
  /// carries, or -1.
  void heed(const GuardMessage& message, int link, double now) noexcept;
  /// Stops all devices at time `now`, s, because the program has ended without a message. A few repetitions
  /// follow, because a stop may be lost on a disturbed line.
  void lose_program(double now) noexcept;
  /// Sends the messages that are due at time `now`, s. Returns whether this call has stopped the devices,
  /// because a beat is missing. While beats are missing, the stop is repeated.
  bool advance(double now) noexcept;
  /// Returns the time at which advance() must be called if no message arrives before, s; HUGE_VAL: never.
  [[nodiscard]] double due() const noexcept;
  /// Returns whether the program has ended.
  [[nodiscard]] bool is_over() const noexcept { return is_over_; }

 protected:
  /// Sends bytes over a link immediately.
  virtual void send(int link, const char* bytes, std::size_t size) noexcept = 0;
  /// Starts to send the first stop messages over a new connection to a device with an address. `device`:
  /// number of the device.
  virtual void send_to_address(std::size_t device, const GuardMessage& stop) noexcept = 0;

 private:
  struct Device {
    int link = -1;
    GuardMessage stop;
  };
  void stop(double now) noexcept;
  [[nodiscard]] double next_repeat() const noexcept;
  void send_rest(double now) noexcept;
  void send_part(std::size_t i, std::size_t from, std::size_t to) noexcept;

  double period_;
  std::array<Device, Guard::most_links> device_{};
  std::array<bool, Guard::most_links> is_rest_due_{};
  std::size_t devices_ = 0;
  bool is_moving_ = false, is_over_ = false, has_rest_ = false;
  int repeats_ = 0;  // Stops that will be repeated before the next beat.
  double beat_ = 0, stopped_ = 0;
};

/// Sends `size` bytes over a link immediately. First discards bytes that a serial line has not sent yet,
/// because a stop must not wait for commands. The function gives up after a short time. Async-signal-safe.
void send_stop(int descriptor, const char* bytes, std::size_t size) noexcept;

/// Main loop of the guarding process. Protects devices until the program sends the message `end` over
/// `socket`. If the other side of `socket` is closed, stops all devices and returns. Allocates no memory and
/// uses only async-signal-safe functions, because it runs after fork() of a process that may have several
/// threads.
void guard_devices(int socket, double period) noexcept;

}  // namespace flexura
