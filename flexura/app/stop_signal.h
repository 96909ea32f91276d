#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <thread>

namespace flexura {

/// Waits for SIGINT or SIGTERM on its own thread. During the lifetime of this object, the creating thread and
/// the threads started by it do not receive these signals. Only one StopSignal may exist at a time.
class StopSignal {
 public:
  /// Starts to wait. Every received signal calls `on_stop` on the waiting thread.
  explicit StopSignal(std::function<void()> on_stop = {});
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  /// Returns the first signal received; 0 if none was received so far.
  [[nodiscard]] int come() const { return come_; }
  /// Blocks until a signal has been received.
  void wait() const;

 private:
  sigset_t signals_{}, before_{};
  std::atomic<int> come_ = 0;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

}  // namespace flexura
