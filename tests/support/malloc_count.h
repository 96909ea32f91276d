#pragma once

#include <atomic>
#include <cstddef>

/// Counts what a test program takes from the heap, Eigen's matrices too: this is its malloc. For one source
/// of a program, and for none that is built with a sanitizer, which has an allocator of its own.

inline std::atomic<long> mallocs{0};

extern "C" {
// glibc's own. NOLINTNEXTLINE(readability-identifier-naming)
void* __libc_malloc(std::size_t size);
// NOLINTNEXTLINE(misc-definitions-in-headers)
void* malloc(std::size_t size) {
  ++mallocs;
  return __libc_malloc(size);
}
}
