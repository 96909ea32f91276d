#pragma once

#include <cstddef>
#include <cstdint>

#include "flexura/kinematics/simd_kernels.h"

// Arithmetic on vectors of doubles, for simd_*.cc alone. V is a vector type of the compiler's (GCC's vector
// extensions, which clang has too) or a plain double; every operation works on each lane by itself and rounds
// once, so that the width changes no bit.
//
// All is in an unnamed namespace: each source has its own copy, compiled for its own instruction set.
namespace flexura {
namespace {

template <typename V>
constexpr std::size_t lanes_of = sizeof(V) / sizeof(double);

// What a comparison of two V gives, and integers as wide as the lanes.
template <typename V>
struct LaneTypes {
  using Mask = decltype(V{} < V{});
  using Bits = Mask;
};
template <>
struct LaneTypes<double> {
  using Mask = bool;
  using Bits = std::int64_t;
};
template <typename V>
using Mask = typename LaneTypes<V>::Mask;
template <typename V>
using Bits = typename LaneTypes<V>::Bits;

template <typename V>
V load(const double* from) {
  V v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

template <typename V>
void store(double* to, const V& v) {
  __builtin_memcpy(to, &v, sizeof v);
}

template <typename V>
V all(double value) {
  return V{} + value;
}

template <typename V>
V square_root(const V& v) {
  double lanes[lanes_of<V>];
  store(lanes, v);
  for (double& lane : lanes) lane = __builtin_sqrt(lane);
  return load<V>(lanes);
}

inline bool any(bool mask) { return mask; }

template <typename M>
bool any(const M& mask) {
  std::int64_t lanes[sizeof(M) / sizeof(std::int64_t)];
  __builtin_memcpy(lanes, &mask, sizeof mask);
  std::int64_t found = 0;
  for (const std::int64_t lane : lanes) found |= lane;
  return found != 0;
}

// c[0] + c[1] z + ... up to z^(n - 1), in pairs, so that less waits for what is before it.
template <std::size_t n, typename V>
V polynomial(const double (&c)[n], const V& z) {
  const V zz = z * z;
  V sum = n % 2 == 0 ? c[n - 2] + z * c[n - 1] : all<V>(c[n - 1]);
  for (std::size_t k = n - 2 + n % 2; k >= 2; k -= 2) sum = (c[k - 2] + z * c[k - 1]) + zz * sum;
  return sum;
}

template <typename V>
struct SineCosine {
  V sine, cosine;
};

// (sin r - r) / r^3 and (cos r - 1 + r^2/2) / r^4 in powers of r^2: nearly minimax on [0, pi/4], off by less
// than 3e-17 (Chebyshev fits made with 200 bits).
constexpr double sine_terms[6] = {-0x1.5555555555555p-3, 0x1.1111111110bb2p-7,   -0x1.a01a019e83816p-13,
                                  0x1.71de379654304p-19, -0x1.ae600aca92c64p-26, 0x1.5e0b05bff20f2p-33};
constexpr double cosine_terms[6] = {0x1.5555555555555p-5,   -0x1.6c16c16c16967p-10, 0x1.a01a019f4e9b4p-16,
                                    -0x1.27e4fa17bf139p-22, 0x1.1eeb68cd22f56p-29,  -0x1.907d8f29fe831p-37};

// Cody and Waite: angle = n pi/2 + r + tail with |r| <= pi/4. pi/2 is the sum of three numbers of which two
// have 33 bits, so that their products with n < 2^20 are exact; the tail is what r cannot hold.
template <typename V>
SineCosine<V> sine_and_cosine(const V& angle) {
  constexpr double first = 0x1.921fb544p+0, second = 0x1.0b4611a6p-34, third = 0x1.3198a2e037073p-69;
  constexpr double to_integer = 0x1.8p52;  // Adding it rounds to an integer and puts that into the low bits.
  const V shifted = angle * 0x1.45f306dc9c883p-1 + to_integer;
  const V n = shifted - to_integer;
  const V coarse = angle - n * first;
  const V w = n * second;
  const V middle = coarse - w;
  const V lost = n * third - ((coarse - middle) - w);
  const V r = middle - lost;
  const V tail = (middle - r) - lost;

  const V z = r * r;
  const V sine = r + ((z * r) * polynomial(sine_terms, z) + (tail - tail * (0.5 * z)));
  const V half = 0.5 * z;
  const V near_one = 1.0 - half;
  const V cosine = near_one + (((1.0 - near_one) - half) + (z * z * polynomial(cosine_terms, z) - r * tail));

  // Quadrants 1 and 3 swap the two; the sine is negative in 2 and 3, the cosine in 1 and 2.
  const auto quadrant = __builtin_bit_cast(Bits<V>, shifted);
  const Mask<V> swaps = (quadrant & 1) != 0;
  const Bits<V> sine_sign = (quadrant & 2) << 62;
  const Bits<V> cosine_sign = ((quadrant + 1) & 2) << 62;
  const V unsigned_sine = swaps ? cosine : sine;
  const V unsigned_cosine = swaps ? sine : cosine;
  SineCosine<V> result;
  result.sine = __builtin_bit_cast(V, __builtin_bit_cast(Bits<V>, unsigned_sine) ^ sine_sign);
  result.cosine = __builtin_bit_cast(V, __builtin_bit_cast(Bits<V>, unsigned_cosine) ^ cosine_sign);

  const Mask<V> is_near = (angle <= 1e6) & (angle >= -1e6);
  if (any(is_near == 0)) {
    double angles[lanes_of<V>], sines[lanes_of<V>], cosines[lanes_of<V>];
    store(angles, angle);
    store(sines, result.sine);
    store(cosines, result.cosine);
    replace_far_sines_and_cosines(angles, sines, cosines, lanes_of<V>);
    result = {load<V>(sines), load<V>(cosines)};
  }
  return result;
}

}  // namespace
}  // namespace flexura
