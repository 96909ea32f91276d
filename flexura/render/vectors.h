#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <cstddef>
#include <cstdint>

// The widest vectors of single numbers that a source is compiled for, and what the compiler's own operators
// (GCC's vector extensions, which clang has too) lack. For sources compiled for one instruction set alone.
//
// All is in an unnamed namespace: each source has its own copy, compiled for its own instruction set.
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

template <typename Vector = Floats>
Vector load(const float* from) {
  Vector v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}
inline void store(float* to, const Floats& v) { __builtin_memcpy(to, &v, sizeof v); }

// max(low, v), and low where v is not a number.
inline Floats at_least(float low, const Floats& v) {
#if defined(__AVX512BW__)
  return _mm512_max_ps(v, _mm512_set1_ps(low));
#elif defined(__AVX2__)
  return _mm256_max_ps(v, _mm256_set1_ps(low));
#elif defined(__SSE2__)
  return _mm_max_ps(v, _mm_set1_ps(low));
#else
  return v > low ? v : Floats{} + low;
#endif
}
inline Floats at_most(float high, const Floats& v) {
#if defined(__AVX512BW__)
  return _mm512_min_ps(v, _mm512_set1_ps(high));
#elif defined(__AVX2__)
  return _mm256_min_ps(v, _mm256_set1_ps(high));
#elif defined(__SSE2__)
  return _mm_min_ps(v, _mm_set1_ps(high));
#else
  return v < high ? v : Floats{} + high;
#endif
}

inline Floats square_root(const Floats& v) {
#if defined(__AVX512BW__)
  return _mm512_sqrt_ps(v);
#elif defined(__AVX2__)
  return _mm256_sqrt_ps(v);
#elif defined(__SSE2__)
  return _mm_sqrt_ps(v);
#else
  Floats root;
  for (std::size_t i = 0; i < lanes; ++i) root[i] = __builtin_sqrtf(v[i]);
  return root;
#endif
}

inline bool is_zero(const Words& v) {
#if defined(__AVX512BW__)
  const auto w = reinterpret_cast<__m512i>(v);
  return _mm512_test_epi32_mask(w, w) == 0;
#elif defined(__AVX2__)
  const auto w = reinterpret_cast<__m256i>(v);
  return _mm256_testz_si256(w, w) != 0;
#elif defined(__SSE2__)
  const auto w = reinterpret_cast<__m128i>(v);
  return _mm_movemask_epi8(_mm_cmpeq_epi8(w, _mm_setzero_si128())) == 0xffff;
#else
  std::uint32_t all = 0;
  for (std::size_t i = 0; i < lanes; ++i) all |= v[i];
  return all == 0;
#endif
}

// Sets `flag` in the bytes whose words of the mask, all ones or zeros, are set.
inline void set_flag(const Words& mask, std::uint8_t flag, std::uint8_t* bytes) {
  const Words flags = mask & flag;
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

// Bytes, one a word.
inline Words words_of(const std::uint8_t* bytes) {
#if defined(__AVX512BW__)
  return reinterpret_cast<Words>(
      _mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes))));
#elif defined(__AVX2__)
  return reinterpret_cast<Words>(
      _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes))));
#else
  Words words;
  for (std::size_t i = 0; i < lanes; ++i) words[i] = bytes[i];
  return words;
#endif
}

// The sum of a word's four bytes, weighted with 64 * 128, 63 * 128, 64 * 125 and 63 * 125 from the lowest on.
inline Words weighted_bytes(const Words& x) {
#if defined(__AVX512BW__)
  const auto pairs = _mm512_maddubs_epi16(reinterpret_cast<__m512i>(x), _mm512_set1_epi16(64 | 63 << 8));
  return reinterpret_cast<Words>(_mm512_madd_epi16(pairs, _mm512_set1_epi32(128 | 125 << 16)));
#elif defined(__AVX2__)
  const auto pairs = _mm256_maddubs_epi16(reinterpret_cast<__m256i>(x), _mm256_set1_epi16(64 | 63 << 8));
  return reinterpret_cast<Words>(_mm256_madd_epi16(pairs, _mm256_set1_epi32(128 | 125 << 16)));
#else
  // Two bytes' weighted sum stays below 2^16, so that both halves of a word hold one.
  const Words pairs = (x & 0x00ff00ffu) * 64 + ((x >> 8) & 0x00ff00ffu) * 63;
#if defined(__SSE2__)
  return reinterpret_cast<Words>(
      _mm_madd_epi16(reinterpret_cast<__m128i>(pairs), _mm_set1_epi32(128 | 125 << 16)));
#else
  return (pairs & 0xffffu) * 128 + (pairs >> 16) * 125;
#endif
#endif
}

// Stores the numbers of `n` vectors, of a size below 2^31, cut to whole ones from 0 to 255.
template <std::size_t n>
void store_bytes(const Floats (&v)[n], std::uint8_t* to) {
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
  // Packing works within the halves of vectors; the last step puts the parts in order.
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

}  // namespace
}  // namespace flexura
