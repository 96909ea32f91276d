#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace flexura {

/// How the samples of a campaign are spread over the distributions of its parameters.
enum class Sampling { random, latin_hypercube, sobol };
const std::vector<std::string>& names_of(const Sampling*);

/// Points in a unit cube, each a function of its index alone.
struct Sampler {
  Sampling sampling = Sampling::random;
  std::uint64_t seed = 1;
  std::uint64_t count = 1;  ///< Number of points. Only a Latin hypercube depends on it.

  /// Returns coordinate `dimension` of point `index` (below `count`), above 0 and below 1. `random`:
  /// independent numbers. `latin_hypercube`: in each dimension, each of `count` equal intervals has one
  /// point, at a random place. `sobol`: the Sobol sequence, shifted by a random binary number (exclusive or),
  /// which keeps its even spread. Throws std::out_of_range beyond the last dimension of a Sobol sequence.
  [[nodiscard]] double at(std::size_t dimension, std::uint64_t index) const;
};

/// Returns the image of `index` (below `count`) under a pseudorandom permutation of the numbers below
/// `count`, which `key` selects. Needs no memory: a Feistel network, repeated until the result is below
/// `count` (J. Black, P. Rogaway, "Ciphers with arbitrary finite domains", 2002).
[[nodiscard]] std::uint64_t permuted(std::uint64_t index, std::uint64_t count, std::uint64_t key);

}  // namespace flexura
