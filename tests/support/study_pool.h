#pragma once

#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace flexura {

/// Calls work(i) for every i below `count`, several at a time, each in one of `threads` threads.
template <class Work>
void for_each_parallel(std::size_t count, unsigned threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> pool;
  pool.reserve(threads);
  for (unsigned i = 0; i < threads; ++i) pool.emplace_back(run);
}

}  // namespace flexura
