#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <cstddef>
#include <cstdint>

// Vectors of floats with the operators of the compiler's vector extensions (GCC and clang), and additional
// functions. Each lane is computed independently and each operation is rounded, so that results are bitwise
// equal for all vector widths. Only all_kernels.h includes this header. The unnamed namespace gives each
// source that is compiled for an instruction set its own copy.
namespace flexura {
namespace {

#if defined(__AVX512BW__)
constexpr std::size_t vector_bytes = 64;
#elif defined(__AVX2__)
constexpr std::size_t vector_bytes = 32;
#else
constexpr std::size_t vector_bytes = 16;
#endif
constexpr std::size_t lanes = vector_bytes / 4;
using Floats = float __attribute__((vector_size(vector_bytes)));
using Words = std::uint32_t __attribute__((vector_size(vector_bytes)));
using Mask = decltype(Floats{} < Floats{});  // All bits of a lane are ones or zeros.

#define FLEXURA_INLINE [[gnu::always_inline]] inline
FLEXURA_INLINE Floats all(float value) { return value - Floats{}; }
FLEXURA_INLINE Floats load(const float* from) {
  Floats v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
FLEXURA_INLINE void store(float* to, const Floats& v) { __builtin_memcpy(to, &v, sizeof v); }
// Returns max(low, v), and low where v is NaN.
FLEXURA_INLINE Floats at_least(float low, const Floats& v) {
#if defined(__AVX512BW__)
  return _mm512_max_ps(v, all(low));
#elif defined(__AVX2__)
  return _mm256_max_ps(v, all(low));
#elif defined(__SSE2__)
  return _mm_max_ps(v, all(low));
#else
  return v > low ? v : all(low);
#endif
}
FLEXURA_INLINE Floats at_most(float high, const Floats& v) { return v < all(high) ? v : all(high); }
FLEXURA_INLINE Floats square_root(const Floats& v) {
  Floats root;
  for (std::size_t i = 0; i < lanes; ++i) root[i] = __builtin_sqrtf(v[i]);
  return root;
}

// Returns one bit per lane, with the first lane in the lowest bit.
FLEXURA_INLINE std::uint32_t bits_of(const Mask& mask) {
#if defined(__AVX512BW__)
  const auto m = reinterpret_cast<__m512i>(mask);
  return _mm512_test_epi32_mask(m, m);
#elif defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#elif defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < lanes; ++i) bits |= mask[i] != 0 ? 1u << i : 0u;
  return bits;
#endif
}

// Sets `flag` in the bytes whose lanes are set in the mask.
FLEXURA_INLINE void set_flag(const Mask& mask, std::uint8_t flag, std::uint8_t* bytes) {
  const Words flags = reinterpret_cast<Words>(mask) & flag;
#if defined(__AVX512BW__)
  const __m128i packed = _mm512_cvtepi32_epi8(reinterpret_cast<__m512i>(flags));
  auto* const to = reinterpret_cast<__m128i*>(bytes);
  _mm_storeu_si128(to, _mm_or_si128(_mm_loadu_si128(to), packed));
#elif defined(__AVX2__)
  const auto w = reinterpret_cast<__m256i>(flags);
  const __m128i pairs = _mm_packs_epi32(_mm256_castsi256_si128(w), _mm256_extracti128_si256(w, 1));
  auto* const to = reinterpret_cast<__m128i*>(bytes);
  _mm_storel_epi64(to, _mm_or_si128(_mm_loadl_epi64(to), _mm_packs_epi16(pairs, pairs)));
#else
  for (std::size_t i = 0; i < lanes; ++i) bytes[i] = static_cast<std::uint8_t>(bytes[i] | flags[i]);
#endif
}
// Returns the mask of bytes that have the flag.
FLEXURA_INLINE Mask has_flag(const std::uint8_t* bytes, std::uint8_t flag) {
#if defined(__AVX512BW__)
  const auto words =
      reinterpret_cast<Words>(_mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes))));
#elif defined(__AVX2__)
  const auto words =
      reinterpret_cast<Words>(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes))));
#else
  Words words;
  for (std::size_t i = 0; i < lanes; ++i) words[i] = bytes[i];
#endif
  return (words & flag) != 0;
}

// Returns the sum of a word's four bytes with the weights 64 * 128, 63 * 128, 64 * 125 and 63 * 125, lowest
// byte first.
FLEXURA_INLINE Words weighted_bytes(const Words& x) {
#if defined(__AVX512BW__)
  const auto pairs = _mm512_maddubs_epi16(reinterpret_cast<__m512i>(x), _mm512_set1_epi16(64 | 63 << 8));
  return reinterpret_cast<Words>(_mm512_madd_epi16(pairs, _mm512_set1_epi32(128 | 125 << 16)));
#elif defined(__AVX2__)
  const auto pairs = _mm256_maddubs_epi16(reinterpret_cast<__m256i>(x), _mm256_set1_epi16(64 | 63 << 8));
  return reinterpret_cast<Words>(_mm256_madd_epi16(pairs, _mm256_set1_epi32(128 | 125 << 16)));
#else
  // The weighted sum of two bytes is below 2^16, so that each half of a word contains one sum.
  const Words pairs = (x & 0x00ff00ffu) * 64 + ((x >> 8) & 0x00ff00ffu) * 63;
#if defined(__SSE2__)
  return reinterpret_cast<Words>(
      _mm_madd_epi16(reinterpret_cast<__m128i>(pairs), _mm_set1_epi32(128 | 125 << 16)));
#else
  return (pairs & 0xffffu) * 128 + (pairs >> 16) * 125;
#endif
#endif
}

// Stores the numbers of `n` vectors, of magnitude below 2^31, truncated and clamped to 0 to 255.
template <std::size_t n>
FLEXURA_INLINE void store_bytes(const Floats (&v)[n], std::uint8_t* to) {
#if defined(__AVX512BW__)
  for (std::size_t j = 0; j < n; ++j) {
    const __m512i whole = _mm512_max_epi32(_mm512_cvttps_epi32(v[j]), _mm512_setzero_si512());
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to + j * lanes), _mm512_cvtusepi32_epi8(whole));
  }
#elif defined(__AVX2__)
  static_assert(n == 4);
  const auto pair = [&v](std::size_t j) {
    return _mm256_packs_epi32(_mm256_cvttps_epi32(v[j]), _mm256_cvttps_epi32(v[j + 1]));
  };
  // Packing works within the halves of vectors; the last step restores the order.
  const __m256i bytes = _mm256_packus_epi16(pair(0), pair(2));
  const __m256i order = _mm256_setr_epi32(0, 4, 1, 5, 2, 6, 3, 7);
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_permutevar8x32_epi32(bytes, order));
#elif defined(__SSE2__)
  static_assert(n == 4);
  const auto pair = [&v](std::size_t j) {
    return _mm_packs_epi32(_mm_cvttps_epi32(v[j]), _mm_cvttps_epi32(v[j + 1]));
  };
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm_packus_epi16(pair(0), pair(2)));
#else
  for (std::size_t i = 0; i < n * lanes; ++i) {
    const auto whole = static_cast<std::int32_t>(v[i / lanes][i % lanes]);
    const std::int32_t low = whole > 0 ? whole : 0;
    to[i] = static_cast<std::uint8_t>(low < 255 ? low : 255);
  }
#endif
}

// Two vectors used as one. The second vector fills the time in which an operation on the first waits for its
// predecessor.
constexpr std::size_t wide_lanes = 2 * lanes;
template <typename V, typename Number>
struct Pair {
  V low = {}, high = {};

  Pair() = default;
  FLEXURA_INLINE Pair(const V& l, const V& h) : low(l), high(h) {}
  FLEXURA_INLINE Pair(Number value) : low(value - V{}), high(low) {}  // NOLINT: as numbers do

// NOLINTBEGIN(bugprone-macro-parentheses): a type and the name of an operator take none.
#define FLEXURA_OPERATOR(Result, op)                                       \
  FLEXURA_INLINE friend Result operator op(const Pair& a, const Pair& b) { \
    return {a.low op b.low, a.high op b.high};                             \
  }
// NOLINTEND(bugprone-macro-parentheses)
#define FLEXURA_OPERATORS(op) \
  FLEXURA_OPERATOR(Pair, op)  \
  FLEXURA_INLINE friend Pair& operator op##=(Pair & a, const Pair & b) { return a = a op b; }
  FLEXURA_OPERATORS(+)
  FLEXURA_OPERATORS(-)
  FLEXURA_OPERATORS(*)
  FLEXURA_OPERATORS(/)
  FLEXURA_OPERATORS(&)
  FLEXURA_OPERATORS(|)
  using Truth = Pair<Mask, std::int32_t>;
  FLEXURA_OPERATOR(Truth, <)
  FLEXURA_OPERATOR(Truth, >)
  FLEXURA_OPERATOR(Truth, <=)
  FLEXURA_OPERATOR(Truth, >=)
#undef FLEXURA_OPERATORS
#undef FLEXURA_OPERATOR
  FLEXURA_INLINE friend Pair operator-(const Pair& a) { return {-a.low, -a.high}; }
  FLEXURA_INLINE friend Pair operator~(const Pair& a) { return {~a.low, ~a.high}; }
};
using Wide = Pair<Floats, float>;
using WideMask = Pair<Mask, std::int32_t>;

FLEXURA_INLINE WideMask mask_of(bool is_set) { return is_set ? -1 : 0; }
FLEXURA_INLINE Wide choose(const WideMask& mask, const Wide& a, const Wide& b) {
  return {mask.low ? a.low : b.low, mask.high ? a.high : b.high};
}
FLEXURA_INLINE Wide size_of(const Wide& a) { return choose(a < 0, -a, a); }
FLEXURA_INLINE Wide at_least(float low, const Wide& v) {
  return {at_least(low, v.low), at_least(low, v.high)};
}
FLEXURA_INLINE Wide square_root(const Wide& v) { return {square_root(v.low), square_root(v.high)}; }
FLEXURA_INLINE Wide wide_load(const float* from) { return {load(from), load(from + lanes)}; }
FLEXURA_INLINE void store(float* to, const Wide& v) { store(to, v.low), store(to + lanes, v.high); }
// Returns the numbers 0, 1, 2, ... in the lanes.
FLEXURA_INLINE Wide counted() {
  Wide count;
  for (std::size_t i = 0; i < lanes; ++i) count.low[i] = static_cast<float>(i);
  count.high = count.low + static_cast<float>(lanes);
  return count;
}
FLEXURA_INLINE std::uint32_t bits_of(const WideMask& mask) {
  return bits_of(mask.low) | bits_of(mask.high) << lanes;
}
FLEXURA_INLINE bool any(const WideMask& mask) { return bits_of(mask.low | mask.high) != 0; }
FLEXURA_INLINE void set_flag(const WideMask& mask, std::uint8_t flag, std::uint8_t* bytes) {
  set_flag(mask.low, flag, bytes), set_flag(mask.high, flag, bytes + lanes);
}
FLEXURA_INLINE WideMask wide_flag(const std::uint8_t* bytes, std::uint8_t flag) {
  return {has_flag(bytes, flag), has_flag(bytes + lanes, flag)};
}
#undef FLEXURA_INLINE

}  // namespace
}  // namespace flexura
