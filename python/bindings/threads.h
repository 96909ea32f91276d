#pragma once

#include <algorithm>
#include <cstddef>
#include <exception>
#include <thread>
#include <vector>

namespace flexura::python {

/// Calls work(begin, end) for parts of [0, count), one part per thread, and returns when all are done. The
/// first part runs on the caller's thread. Rethrows the exception of the first part that has one.
template <class Work>
void share_out(std::size_t count, std::size_t threads, const Work& work) {
  threads = std::clamp<std::size_t>(threads, 1, std::max<std::size_t>(count, 1));
  if (threads == 1) return work(0, count);
  std::vector<std::exception_ptr> thrown(threads);
  const auto part = [&](std::size_t i) {
    try {
      work(count * i / threads, count * (i + 1) / threads);
    } catch (...) {
      thrown[i] = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < threads; ++i) others.emplace_back(part, i);
    part(0);
  }
  for (const std::exception_ptr& error : thrown)
    if (error) std::rethrow_exception(error);
}

}  // namespace flexura::python
