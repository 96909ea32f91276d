#include "flexura/campaign/sobol.h"

#include <array>
#include <stdexcept>

namespace flexura {
namespace {

constexpr std::size_t bits = 32;

// A primitive polynomial with the first direction numbers of a dimension.
struct Primitive {
  unsigned degree;
  unsigned coefficients;  // Of the powers degree - 1 to 1, as bits.
  std::array<std::uint32_t, 7> first;
};

// Of the dimensions from 1 on; dimension 0 is the van der Corput sequence.
constexpr std::array<Primitive, most_sobol_dimensions - 1> primitives{{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
    {7, 7, {1, 1, 3, 13, 7, 35, 63}},
    {7, 8, {1, 3, 5, 9, 1, 25, 53}},
    {7, 14, {1, 3, 1, 13, 9, 35, 107}},
    {7, 19, {1, 3, 1, 5, 27, 61, 31}},
    {7, 21, {1, 1, 5, 11, 19, 41, 61}},
    {7, 28, {1, 3, 5, 3, 3, 13, 69}},
    {7, 31, {1, 1, 7, 13, 1, 19, 1}},
    {7, 32, {1, 3, 7, 5, 13, 19, 59}},
    {7, 37, {1, 1, 3, 9, 25, 29, 41}},
    {7, 41, {1, 3, 5, 13, 23, 1, 55}},
    {7, 42, {1, 3, 7, 3, 13, 59, 17}},
}};

using Directions = std::array<std::uint32_t, bits>;

constexpr Directions directions_of(std::size_t dimension) {
  Directions v{};
  if (dimension == 0) {
    for (std::size_t i = 0; i < bits; ++i) v[i] = std::uint32_t{1} << (bits - 1 - i);
    return v;
  }
  const Primitive& p = primitives[dimension - 1];
  for (std::size_t i = 0; i < p.degree; ++i) v[i] = p.first[i] << (bits - 1 - i);
  for (std::size_t i = p.degree; i < bits; ++i) {
    v[i] = v[i - p.degree] ^ (v[i - p.degree] >> p.degree);
    for (std::size_t k = 1; k < p.degree; ++k)
      if (((p.coefficients >> (p.degree - 1 - k)) & 1U) != 0) v[i] ^= v[i - k];
  }
  return v;
}

constexpr std::array<Directions, most_sobol_dimensions> all_directions() {
  std::array<Directions, most_sobol_dimensions> all{};
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = directions_of(i);
  return all;
}

}  // namespace

std::uint32_t sobol(std::size_t dimension, std::uint32_t index) {
  static constexpr auto directions = all_directions();
  if (dimension >= most_sobol_dimensions) throw std::out_of_range("a Sobol sequence has 32 dimensions");
  std::uint32_t x = 0;
  for (std::size_t i = 0; index != 0; index >>= 1, ++i)
    if ((index & 1U) != 0) x ^= directions[dimension][i];
  return x;
}

}  // namespace flexura
