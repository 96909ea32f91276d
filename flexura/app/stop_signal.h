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

  /// The first that has come; 0: none.
  [[nodiscard]] int come() const { return come_; }
  /// Returns when one has come.
  void wait() const;

 private:
  sigset_t signals_{}, before_{};
  std::atomic<int> come_ = 0;
  std::atomic<bool> is_over_ = false;
  std::thread thread_;
};

}  // namespace flexura
