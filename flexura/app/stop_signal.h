#pragma once

#include <atomic>
#include <csignal>
#include <functional>
#include <thread>

namespace flexura {

/// Waits for SIGINT or SIGTERM on a thread of its own; this thread and those that it starts do not get them
/// any more. One at a time.
class StopSignal {
 public:
  /// `on_stop` is called there, for every one that comes.
  explicit StopSignal(std::function<void()> on_stop = {});
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  /// Whether one has come.
  [[nodiscard]] bool has_come() const { return has_come_; }
  /// Returns when one has come.
  void wait() const;

 private:
  sigset_t signals_{}, before_{};
  std::atomic<bool> has_come_ = false, is_over_ = false;
  std::thread thread_;
};

}  // namespace flexura
