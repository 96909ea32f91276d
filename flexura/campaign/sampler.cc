#include "flexura/campaign/sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "flexura/campaign/sobol.h"
#include "flexura/math/hash.h"

namespace flexura {
namespace {

// Keys of independent random numbers of one seed.
enum Stream : std::uint64_t { of_value = 1, of_order = 2, of_shift = 3 };

// Returns a number above 0 and below 1 from 64 random bits.
double fraction_of(std::uint64_t random) { return (static_cast<double>(random >> 12) + 0.5) * 0x1p-52; }

}  // namespace

const std::vector<std::string>& names_of(const Sampling*) {
  static const std::vector<std::string> names{"random", "latin_hypercube", "sobol"};
  return names;
}

double Sampler::at(std::size_t dimension, std::uint64_t index) const {
  const double inside = fraction_of(hash(seed, of_value, dimension, index));
  if (sampling == Sampling::random) return inside;
  if (sampling == Sampling::latin_hypercube) {
    const std::uint64_t interval = permuted(index, count, hash(seed, of_order, dimension));
    const double value = (static_cast<double>(interval) + inside) / static_cast<double>(count);
    return std::min(value, 1 - 0x1p-53);
  }
  const auto shift = static_cast<std::uint32_t>(hash(seed, of_shift, dimension) >> 32);
  return (static_cast<double>(sobol(dimension, static_cast<std::uint32_t>(index)) ^ shift) + 0.5) * 0x1p-32;
}

std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t key) {
  if (count < 2) return index;
  const auto half = static_cast<std::uint64_t>(std::bit_width(count - 1) + 1) / 2;
  const std::uint64_t mask = (std::uint64_t{1} << half) - 1;
  constexpr std::uint64_t rounds = 6;
  do {
    std::uint64_t left = index >> half, right = index & mask;
    for (std::uint64_t round = 0; round < rounds; ++round) {
      const std::uint64_t next = left ^ (hash(key, round, right) & mask);
      left = right, right = next;
    }
    index = (left << half) | right;
  } while (index >= count);
  return index;
}

}  // namespace flexura
