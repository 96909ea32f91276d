#include "flexura/sim/thread_pool.h"

#include <algorithm>

namespace flexura {

ThreadPool::ThreadPool(std::size_t threads) {
  thrown_.resize(std::max<std::size_t>(threads, 1));
  helpers_.reserve(thrown_.size() - 1);
  for (std::size_t place = 1; place < thrown_.size(); ++place)
    helpers_.emplace_back([this, place] { help(place); });
}

ThreadPool::~ThreadPool() {
  {
    const std::scoped_lock lock(mutex_);
    is_over_ = true;
  }
  begun_.notify_all();
}

void ThreadPool::run(std::size_t count, const Job& job) {
  if (count <= 1 || helpers_.empty()) {
    for (std::size_t i = 0; i < count; ++i) job(i);
    return;
  }
  {
    const std::scoped_lock lock(mutex_);
    job_ = &job, count_ = count, busy_ = helpers_.size();
    std::ranges::fill(thrown_, nullptr);
    ++round_;
  }
  begun_.notify_all();
  work(0);
  {
    std::unique_lock lock(mutex_);
    ended_.wait(lock, [this] { return busy_ == 0; });
  }
  for (const std::exception_ptr& problem : thrown_)
    if (problem) std::rethrow_exception(problem);
}

void ThreadPool::help(std::size_t place) {
  std::uint64_t done = 0;  // the last round
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      begun_.wait(lock, [&] { return is_over_ || round_ != done; });
      if (is_over_) return;
      done = round_;
    }
    work(place);
    const std::scoped_lock lock(mutex_);
    if (--busy_ == 0) ended_.notify_one();
  }
}

void ThreadPool::work(std::size_t place) {
  try {
    for (std::size_t i = place; i < count_; i += thrown_.size()) (*job_)(i);
  } catch (...) {
    thrown_[place] = std::current_exception();
  }
}

}  // namespace flexura
