#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace flexura {

/// A pool of threads that run jobs in parallel and sleep in between. The simulator renders frames with one
/// thread per camera.
class ThreadPool {
 public:
  /// Job function. The argument of the function is the number of the job.
  using Job = std::function<void(std::size_t)>;

  /// Creates a pool of `threads` >= 1 threads, including the caller's thread.
  explicit ThreadPool(std::size_t threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Calls job(0) ... job(count - 1) and returns when all are done. The assignment of jobs to threads is
  /// fixed: jobs i and i + threads() run on one thread, in this order. A thread stops at its first exception.
  /// run() rethrows the exception of the thread with the lowest number. run() must not be called from two
  /// threads at once.
  void run(std::size_t count, const Job& job);

  /// Returns the number of threads, including the caller's thread.
  [[nodiscard]] std::size_t threads() const { return helpers_.size() + 1; }

 private:
  void help(std::size_t place);
  void work(std::size_t place);

  std::mutex mutex_;
  std::condition_variable begun_, ended_;
  // Guarded by the mutex, except job_ and count_ while a round runs: they do not change while a helper is
  // busy.
  const Job* job_ = nullptr;
  std::size_t count_ = 0;
  std::uint64_t round_ = 0;
  std::size_t busy_ = 0;  // Number of helpers still working.
  bool is_over_ = false;
  std::vector<std::exception_ptr> thrown_;  // One per thread.
  std::vector<std::jthread> helpers_;
};

}  // namespace flexura
