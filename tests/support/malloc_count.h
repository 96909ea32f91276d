#pragma once

#include <atomic>
#include <cstddef>

/// Counts the heap allocations of a test program, including Eigen's matrices, by replacing malloc. Include it
/// in one source of a program only, and never with a sanitizer, which replaces malloc itself.

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
