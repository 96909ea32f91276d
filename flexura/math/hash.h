#pragma once

#include <cstdint>

namespace flexura {

/// A pseudorandom permutation of the 64-bit numbers: the finalizer of SplitMix64 (Steele, Lea, Flood 2014).
/// Hashes of consecutive integers form a random number stream that needs no stored state.
constexpr std::uint64_t hash(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// Returns a hash of several numbers. The hash depends on the order of the numbers.
template <typename... Rest>
constexpr std::uint64_t hash(std::uint64_t first, std::uint64_t second, Rest... rest) {
  return hash(hash(first) ^ second, rest...);
}

}  // namespace flexura
