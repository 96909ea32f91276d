#include "flexura/campaign/worker_pool.h"

#include <utility>

namespace flexura {

WorkerPool::WorkerPool(RunFunction run, std::size_t threads) : run_(std::move(run)) {
  threads_.reserve(threads);
  for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

WorkerPool::~WorkerPool() {
  {
    const std::scoped_lock lock(mutex_);
    cancellation_.is_set = true;
  }
  added_.notify_all();
  threads_.clear();  // Joins before the other members end.
}

void WorkerPool::add(std::int64_t id) {
  {
    const std::scoped_lock lock(mutex_);
    to_do_.push_back(id);
  }
  ++pending_;
  added_.notify_one();
}

std::vector<CampaignRow> WorkerPool::take(std::chrono::microseconds patience) {
  std::vector<CampaignRow> taken;
  std::unique_lock lock(mutex_);
  finished_.wait_for(lock, patience, [this] { return !rows_.empty() || thrown_ != nullptr; });
  // Rows that were finished before a failure are passed on first.
  if (rows_.empty() && thrown_ != nullptr) std::rethrow_exception(thrown_);
  taken.swap(rows_);
  pending_ -= taken.size();
  return taken;
}

void WorkerPool::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    added_.wait(lock, [this] { return cancellation_.is_set || !to_do_.empty(); });
    if (cancellation_.is_set) return;
    const std::int64_t id = to_do_.front();
    to_do_.pop_front();
    lock.unlock();
    std::optional<CampaignRow> row;
    std::exception_ptr thrown;
    try {
      row = run_(id, cancellation_);
    } catch (...) {
      thrown = std::current_exception();
    }
    lock.lock();
    if (row) rows_.push_back(std::move(*row));
    if (thrown != nullptr && thrown_ == nullptr) thrown_ = thrown;
    finished_.notify_one();
    if (thrown != nullptr) return;
  }
}

}  // namespace flexura
