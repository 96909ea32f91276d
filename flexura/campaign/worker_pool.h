#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "flexura/base/progress.h"
#include "flexura/campaign/campaign.h"

namespace flexura {

/// Executes a run by its number. Returns std::nullopt if the run was cancelled. Called by several threads.
using RunFunction = std::function<std::optional<CampaignRow>(std::int64_t id, Progress& progress)>;

/// Threads that execute runs. All functions are called by one thread.
class WorkerPool {
 public:
  WorkerPool(RunFunction run, std::size_t threads);
  /// Cancels all runs.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  [[nodiscard]] std::size_t threads() const { return threads_.size(); }
  /// Returns the number of runs that were added, and not yet taken.
  [[nodiscard]] std::size_t pending() const { return pending_; }
  void add(std::int64_t id);
  /// Returns finished runs, in any order. If no run is finished, waits for at most `patience`. Throws what a
  /// run threw.
  [[nodiscard]] std::vector<CampaignRow> take(std::chrono::microseconds patience);

 private:
  class Cancellation : public Progress {
   public:
    void update(double /*fraction*/, std::string_view /*what*/) override {}
    [[nodiscard]] bool is_cancelled() const override { return is_set; }
    std::atomic<bool> is_set = false;
  };
  void work();

  RunFunction run_;
  std::size_t pending_ = 0;
  Cancellation cancellation_;
  std::mutex mutex_;
  std::condition_variable added_, finished_;
  // Guarded by the mutex.
  std::deque<std::int64_t> to_do_;
  std::vector<CampaignRow> rows_;
  std::exception_ptr thrown_;
  std::vector<std::jthread> threads_;
};

}  // namespace flexura
