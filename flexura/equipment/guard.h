#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "flexura/equipment/descriptor.h"
#include "flexura/equipment/link.h"

namespace flexura {

/// How to stop a device: messages that are sent at once, then others after a delay. A controller may first
/// have to brake and then to forget its program.
struct StopMessages {
  std::vector<std::string> first;  ///< Each is sent by a write of its own.
  double delay = 0;                ///< s
  std::vector<std::string> then;   ///< Sent `delay` s after the first.
};

struct GuardMessage;

/// Stops devices if the program does not report in time that it works.
class Watchdog {
 public:
  virtual ~Watchdog() = default;
  Watchdog() = default;
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Returns the longest time between beats while the arm moves, s.
  [[nodiscard]] virtual double period() const = 0;
  /// Reports that this program works. `is_moving`: whether the next beat is due within a period. Returns
  /// false if the devices have been stopped since the previous beat. Any thread.
  virtual bool beat(bool is_moving) = 0;
};

/// Stops devices when this program dies or hangs, or on request.
///
/// A second process holds copies of the devices' links. While the arm moves, this program must call beat()
/// once a period. If it does not, or if it ends without notice (even by SIGKILL), the second process sends
/// the stop messages over every link, or over new connections. It survives what ends this program alone, but
/// not a loss of power, and not a kill of all processes of the machine or of a container.
///
/// All functions may be called from several threads.
class Guard : public Watchdog {
 public:
  static constexpr std::size_t most_links = 16;       ///< Devices that a guard can protect.
  static constexpr std::size_t most_messages = 16;    ///< Stop messages of a device.
  static constexpr std::size_t messages_size = 4096;  ///< Bytes of all stop messages of a device.

  /// Starts the second process. `period`, s, > 0: the longest time between beats while the arm moves. Throws
  /// std::runtime_error if the system cannot start a process.
  explicit Guard(double period);
  /// Ends the second process, without a stop.
  ~Guard() override;
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  [[nodiscard]] double period() const override { return period_; }

  /// Protects the device at a link, from now on, by these messages. Throws std::invalid_argument if the link
  /// has no descriptor, there are too many messages or links, or a message is too long. Throws
  /// std::runtime_error if the second process does not answer.
  void protect(const Link& link, const StopMessages& stop);
  /// Protects the device at a TCP address, from now on. The second process sends the first stop messages over
  /// a new connection; there may be no later ones. Returns a number for renew(). Throws std::invalid_argument
  /// like the other protect(), or if the address is not of TCP; std::runtime_error if the name of the host is
  /// unknown or the second process does not answer.
  std::size_t protect(const LinkAddress& address, const StopMessages& stop);
  /// Replaces the stop messages of a device at a TCP address. Throws like protect().
  void renew(std::size_t number, const StopMessages& stop);

  bool beat(bool is_moving) override;

  /// Sends the first stop messages over all links at once. Async-signal-safe: a handler of signals may call
  /// it. The second process then sends the rest. Later commands of this program may move devices again.
  void stop() noexcept;

 private:
  struct Protected {
    int descriptor = -1;
    std::array<char, messages_size> text{};  // One message after the other.
    std::array<std::size_t, most_messages> sizes{};
    std::size_t count = 0;
  };
  void send_new(const GuardMessage& message, int link);

  double period_;
  Descriptor socket_;
  int child_ = -1;
  std::mutex protecting_;
  std::array<Protected, most_links> protected_{};
  std::atomic<std::size_t> links_ = 0;  // stop() may interrupt protect().
};

}  // namespace flexura
