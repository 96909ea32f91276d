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

/// Threads that do jobs together and sleep in between: a camera's each, where frames are drawn.
class ThreadPool {
 public:
  using Job = std::function<void(std::size_t)>;  ///< Takes the job's number.

  /// `threads` of them, the caller's among them; at least that one.
  explicit ThreadPool(std::size_t threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Calls job(0) ... job(count - 1), and returns when all are done. Which thread does which is fixed: job i
  /// and job i + threads() are one thread's, one after the other. A thread's jobs end where one throws; of
  /// what the threads threw, the first's is thrown here. Not to be called from two threads at once.
  void run(std::size_t count, const Job& job);

  /// The caller's among them.
  [[nodiscard]] std::size_t threads() const { return helpers_.size() + 1; }

 private:
  void help(std::size_t place);
  void work(std::size_t place);

  std::mutex mutex_;
  std::condition_variable begun_, ended_;
  // Guarded by the mutex, but for what a round's own jobs are: nobody changes them while any helper is busy.
  const Job* job_ = nullptr;
  std::size_t count_ = 0;
  std::uint64_t round_ = 0;
  std::size_t busy_ = 0;  // helpers
  bool is_over_ = false;
  std::vector<std::exception_ptr> thrown_;  // one a thread
  std::vector<std::jthread> helpers_;
};

}  // namespace flexura
