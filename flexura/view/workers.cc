#include "flexura/view/workers.h"

#include <cstddef>
#include <exception>
#include <stdexcept>
#include <string>
#include <utility>

namespace flexura {

Workers::Workers(std::function<void(After)> back) : back_(std::move(back)) {
  for (std::size_t i = 0; i < lane_count; ++i) threads_[i] = std::thread([this, i] { work(queues_[i]); });
}

Workers::~Workers() {
  for (Queue& queue : queues_) {
    const std::lock_guard lock(queue.mutex);
    queue.is_over = true;
    queue.filled.notify_one();
  }
  for (std::thread& thread : threads_) thread.join();
}

void Workers::run(Lane lane, Job job) {
  Queue& queue = queues_.at(static_cast<std::size_t>(lane));
  const std::lock_guard lock(queue.mutex);
  queue.jobs.push_back(std::move(job));
  queue.filled.notify_one();
}

void Workers::work(Queue& queue) {
  for (;;) {
    std::unique_lock lock(queue.mutex);
    queue.filled.wait(lock, [&] { return queue.is_over || !queue.jobs.empty(); });
    if (queue.is_over) return;
    const Job job = std::move(queue.jobs.front());
    queue.jobs.pop_front();
    lock.unlock();
    After after;
    try {
      after = job();
    } catch (const std::exception& error) {
      // Rethrown on the session's thread, where other failures are reported.
      after = [why = std::string(error.what())] { throw std::runtime_error(why); };
    }
    if (after) back_(std::move(after));
  }
}

}  // namespace flexura
