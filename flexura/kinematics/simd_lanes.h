#pragma once

#include <cstddef>
#include <cstdint>

#include "flexura/kinematics/simd_kernels.h"

// Arithmetic on vectors of doubles, for simd_*.cc alone. V is a vector type of the compiler's (GCC's vector
// extensions, which clang has too), two of them side by side, or a plain double; every operation works on
// each lane by itself and rounds once, so that the width changes no bit.
//
// All is in an unnamed namespace: each source has its own copy, compiled for its own instruction set.
namespace flexura {
namespace {

// Two vectors in step. What is computed here waits for what was
// computed just before; the second vector's work fills the time.
template <typename V>
struct Two {
  V a, b;
};
template <typename V>
Two<V> operator+(const Two<V>& u, const Two<V>& v) {
  return {u.a + v.a, u.b + v.b};
}
template <typename V>
Two<V> operator-(const Two<V>& u, const Two<V>& v) {
  return {u.a - v.a, u.b - v.b};
}
template <typename V>
Two<V> operator*(const Two<V>& u, const Two<V>& v) {
  return {u.a * v.a, u.b * v.b};
}
template <typename V>
Two<V> operator/(const Two<V>& u, const Two<V>& v) {
  return {u.a / v.a, u.b / v.b};
}
template <typename V>
Two<V> operator+(const Two<V>& u, double s) {
  return {u.a + s, u.b + s};
}
template <typename V>
Two<V> operator-(const Two<V>& u, double s) {
  return {u.a - s, u.b - s};
}
template <typename V>
Two<V> operator*(const Two<V>& u, double s) {
  return {u.a * s, u.b * s};
}
template <typename V>
Two<V> operator+(double s, const Two<V>& v) {
  return {s + v.a, s + v.b};
}
template <typename V>
Two<V> operator-(double s, const Two<V>& v) {
  return {s - v.a, s - v.b};
}
template <typename V>
Two<V> operator*(double s, const Two<V>& v) {
  return {s * v.a, s * v.b};
}

// The narrowest that holds four lanes.
#ifdef __AVX2__
using FourLanes = double __attribute__((vector_size(32)));
#else
using FourLanes = Two<double __attribute__((vector_size(16)))>;
#endif

template <typename V>
constexpr std::size_t lanes_of = sizeof(V) / 8;

// Integers as wide as the lanes.
template <typename V>
struct BitsOf {
  using Type = decltype(V{} < V{});
};
template <>
struct BitsOf<double> {
  using Type = std::int64_t;
};

// Reads and writes V without asking for its alignment. By way of a struct, as partial specialization needs.
template <typename V>
struct Memory {
  static V load(const double* from) {
    V v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
  }
  static void store(double* to, const V& v) { __builtin_memcpy(to, &v, sizeof v); }
  static V all(double value) { return V{} + value; }
};
template <typename V>
struct Memory<Two<V>> {
  static Two<V> load(const double* from) {
    return {Memory<V>::load(from), Memory<V>::load(from + lanes_of<V>)};
  }
  static void store(double* to, const Two<V>& v) {
    Memory<V>::store(to, v.a);
    Memory<V>::store(to + lanes_of<V>, v.b);
  }
  static Two<V> all(double value) { return {Memory<V>::all(value), Memory<V>::all(value)}; }
};
template <typename V>
V load(const double* from) {
  return Memory<V>::load(from);
}
template <typename V>
void store(double* to, const V& v) {
  Memory<V>::store(to, v);
}
template <typename V>
V all(double value) {
  return Memory<V>::all(value);
}

template <typename V>
V square_root(const V& v) {
  double lanes[lanes_of<V>];
  store(lanes, v);
  for (double& lane : lanes) lane = __builtin_sqrt(lane);
  return load<V>(lanes);
}
template <typename V>
Two<V> square_root(const Two<V>& v) {
  return {square_root(v.a), square_root(v.b)};
}

// Whether an angle is beyond 1e6 or not a number.
inline bool any_is_far(double angle) { return !(__builtin_fabs(angle) <= 1e6); }
template <typename V>
bool any_is_far(const V& angle) {
  const auto is_far = ((angle <= 1e6) & (angle >= -1e6)) == 0;
  std::int64_t lanes[lanes_of<V>];
  __builtin_memcpy(lanes, &is_far, sizeof is_far);
  std::int64_t found = 0;
  for (const std::int64_t lane : lanes) found |= lane;
  return found != 0;
}
template <typename V>
bool any_is_far(const Two<V>& angle) {
  return any_is_far(angle.a) || any_is_far(angle.b);
}

// Lane by lane: a where x is under the limit (or zero), else b.
template <typename V>
V where_less(const V& x, double limit, const V& a, const V& b) {
  return x < limit ? a : b;
}
template <typename V>
Two<V> where_less(const Two<V>& x, double limit, const Two<V>& a, const Two<V>& b) {
  return {where_less(x.a, limit, a.a, b.a), where_less(x.b, limit, a.b, b.b)};
}
template <typename V>
V where_zero(const V& x, double a, const V& b) {
  return x == 0.0 ? V{} + a : b;
}
template <typename V>
Two<V> where_zero(const Two<V>& x, double a, const Two<V>& b) {
  return {where_zero(x.a, a, b.a), where_zero(x.b, a, b.b)};
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

// To quadrant q (in the low two bits of `shifted`): 1 and 3 swap sine and cosine; the sine is negative in 2
// and 3, the cosine in 1 and 2.
template <typename V>
SineCosine<V> in_quadrant(const V& shifted, const SineCosine<V>& first) {
  using Bits = typename BitsOf<V>::Type;
  const Bits quadrant = __builtin_bit_cast(Bits, shifted);
  const auto swaps = (quadrant & 1) != 0;
  const V sine = swaps ? first.cosine : first.sine;
  const V cosine = swaps ? first.sine : first.cosine;
  const Bits sine_sign = (quadrant & 2) << 62;
  const Bits cosine_sign = ((quadrant + 1) & 2) << 62;
  return {__builtin_bit_cast(V, __builtin_bit_cast(Bits, sine) ^ sine_sign),
          __builtin_bit_cast(V, __builtin_bit_cast(Bits, cosine) ^ cosine_sign)};
}
template <typename V>
SineCosine<Two<V>> in_quadrant(const Two<V>& shifted, const SineCosine<Two<V>>& first) {
  const auto a = in_quadrant<V>(shifted.a, {first.sine.a, first.cosine.a});
  const auto b = in_quadrant<V>(shifted.b, {first.sine.b, first.cosine.b});
  return {{a.sine, b.sine}, {a.cosine, b.cosine}};
}

// Cody and Waite: angle = n pi/2 + r with |r| <= pi/4. pi/2 is the sum of three numbers of which two have 33
// bits, so that their products with n < 2^20 are exact.
template <typename V>
SineCosine<V> sine_and_cosine(const V& angle) {
  constexpr double first = 0x1.921fb544p+0, second = 0x1.0b4611a6p-34, third = 0x1.3198a2e037073p-69;
  constexpr double to_integer = 0x1.8p52;  // Adding it rounds to an integer and puts that into the low bits.
  const V shifted = angle * 0x1.45f306dc9c883p-1 + to_integer;
  const V n = shifted - to_integer;
  const V r = ((angle - n * first) - n * second) - n * third;
  const V z = r * r;
  const V sine = r + (z * r) * polynomial(sine_terms, z);
  const V cosine = 1.0 - (0.5 * z - (z * z) * polynomial(cosine_terms, z));
  SineCosine<V> result = in_quadrant(shifted, SineCosine<V>{sine, cosine});
  if (any_is_far(angle)) [[unlikely]] {
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
