#pragma once

#include <array>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "flexura/view/background.h"

namespace flexura {

/// Executes background work, with one thread per lane (queue).
class Workers : public Background {
 public:
  /// `back` receives functions that must be called on the session's thread. `back` itself is called from any
  /// thread.
  explicit Workers(std::function<void(After)> back);
  /// Finishes active jobs and discards waiting jobs.
  ~Workers() override;

  void run(Lane lane, Job job) override;

 private:
  struct Queue {
    std::mutex mutex;
    std::condition_variable filled;
    std::deque<Job> jobs;
    bool is_over = false;
  };
  void work(Queue& queue);

  std::function<void(After)> back_;
  std::array<Queue, lane_count> queues_;
  std::array<std::thread, lane_count> threads_;
};

}  // namespace flexura
