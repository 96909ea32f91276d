#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "flexura/base/descriptor.h"
#include "flexura/equipment/link.h"

namespace flexura {

/// Messages that stop a device. The first messages are sent immediately, the others after a delay. For
/// example, a controller must first brake, and then delete its queued motions.
struct StopMessages {
  std::vector<std::string> first;  ///< First messages; each is sent by a separate write.
  double delay = 0;                ///< Delay after the first messages, s.
  std::vector<std::string> then;   ///< Messages that are sent `delay` s after the first messages.
};

struct GuardMessage;

/// Stops the devices if the program sends no sign of life (beat) in time.
class Watchdog {
 public:
  virtual ~Watchdog() = default;
  Watchdog() = default;
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

  /// Returns the longest allowed time between two beats while the arm moves, s.
  [[nodiscard]] virtual double period() const = 0;
  /// Sends a sign of life of this program. `is_moving`: whether the next beat must follow within a period.
  /// Returns false if the devices have been stopped since the previous beat. May be called from any thread.
  virtual bool beat(bool is_moving) = 0;
};

/// Stops the devices if this program crashes or hangs, or on request.
///
/// A second process holds copies of the devices' links. While the arm moves, this program must call beat()
/// once a period. If a beat is missing, or if this program ends without a message (even by SIGKILL), the
/// second process sends the stop messages over every link, or over new connections. The guard cannot stop
/// devices after a loss of power, or if all processes of the computer or of a container are killed.
///
/// All functions may be called from several threads.
class Guard : public Watchdog {
 public:
  static constexpr std::size_t most_links = 16;     ///< Largest number of devices that a guard protects.
  static constexpr std::size_t most_messages = 16;  ///< Largest number of stop messages of a device.
  static constexpr std::size_t messages_size =
      4096;  ///< Largest size of all stop messages of a device, bytes.

  /// Starts the second process. `period`, s, > 0: the longest time between beats while the arm moves. Throws
  /// std::runtime_error if the system cannot start a process.
  explicit Guard(double period);
  /// Ends the second process without stopping the devices.
  ~Guard() override;
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;

  [[nodiscard]] double period() const override { return period_; }

  /// Protects the device at a link from now on: `stop` are the messages that stop the device. Throws
  /// std::invalid_argument if the link has no descriptor, there are too many messages or links, or a message
  /// is too long. Throws std::runtime_error if the second process does not answer.
  void protect(const Link& link, const StopMessages& stop);
  /// Protects the device at a TCP address from now on. The second process sends the first stop messages over
  /// a new connection. Messages with a delay are not allowed. Returns a number for renew(). Throws
  /// std::invalid_argument like the other protect(), or if the address is not a TCP address. Throws
  /// std::runtime_error if the host name is unknown or the second process does not answer.
  std::size_t protect(const LinkAddress& address, const StopMessages& stop);
  /// Replaces the stop messages of a device at a TCP address. Throws like protect().
  void renew(std::size_t number, const StopMessages& stop);

  bool beat(bool is_moving) override;

  /// Sends the first stop messages over all links immediately. The second process then sends the other
  /// messages. Async-signal-safe, so that a signal handler may call it. Later commands of this program may
  /// move the devices again.
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
