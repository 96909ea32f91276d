#pragma once

#include <cstddef>
#include <cstdint>

#include "flexura/render/vectors.h"

// Two vectors as one: what is computed for one waits for what was computed just before, and the other fills
// the time. For sources compiled for one instruction set alone, like vectors.h.
namespace flexura {
namespace {

constexpr std::size_t wide_lanes = 2 * lanes;

#define FLEXURA_INLINE [[gnu::always_inline]] inline
struct WideMask {
  using Half = decltype(Floats{} < Floats{});
  Half low = {}, high = {};

  WideMask() = default;
  FLEXURA_INLINE WideMask(const Half& l, const Half& h) : low(l), high(h) {}
  FLEXURA_INLINE explicit WideMask(bool is_set) : low(Half{} - (is_set ? 1 : 0)), high(low) {}
};
FLEXURA_INLINE WideMask operator&(const WideMask& p, const WideMask& q) {
  return {p.low & q.low, p.high & q.high};
}
FLEXURA_INLINE WideMask operator|(const WideMask& p, const WideMask& q) {
  return {p.low | q.low, p.high | q.high};
}
FLEXURA_INLINE WideMask operator~(const WideMask& p) { return {~p.low, ~p.high}; }

struct Wide {
  Floats low = {}, high = {};

  Wide() = default;
  FLEXURA_INLINE Wide(const Floats& l, const Floats& h) : low(l), high(h) {}
  FLEXURA_INLINE Wide(float value)
      : low(Floats{} + value), high(Floats{} + value) {}  // NOLINT: as numbers do
};
FLEXURA_INLINE Wide operator+(const Wide& a, const Wide& b) { return {a.low + b.low, a.high + b.high}; }
FLEXURA_INLINE Wide operator-(const Wide& a, const Wide& b) { return {a.low - b.low, a.high - b.high}; }
FLEXURA_INLINE Wide operator*(const Wide& a, const Wide& b) { return {a.low * b.low, a.high * b.high}; }
FLEXURA_INLINE Wide operator/(const Wide& a, const Wide& b) { return {a.low / b.low, a.high / b.high}; }
FLEXURA_INLINE Wide operator-(const Wide& a) { return {-a.low, -a.high}; }
FLEXURA_INLINE WideMask operator<(const Wide& a, const Wide& b) { return {a.low < b.low, a.high < b.high}; }
FLEXURA_INLINE WideMask operator>(const Wide& a, const Wide& b) { return {a.low > b.low, a.high > b.high}; }
FLEXURA_INLINE WideMask operator<=(const Wide& a, const Wide& b) {
  return {a.low <= b.low, a.high <= b.high};
}
FLEXURA_INLINE WideMask operator>=(const Wide& a, const Wide& b) {
  return {a.low >= b.low, a.high >= b.high};
}

FLEXURA_INLINE Wide& operator+=(Wide& a, const Wide& b) { return a = a + b; }
FLEXURA_INLINE Wide& operator-=(Wide& a, const Wide& b) { return a = a - b; }
FLEXURA_INLINE Wide& operator*=(Wide& a, const Wide& b) { return a = a * b; }
FLEXURA_INLINE WideMask& operator&=(WideMask& p, const WideMask& q) { return p = p & q; }
FLEXURA_INLINE WideMask& operator|=(WideMask& p, const WideMask& q) { return p = p | q; }

FLEXURA_INLINE Wide choose(const WideMask& mask, const Wide& a, const Wide& b) {
  return {mask.low ? a.low : b.low, mask.high ? a.high : b.high};
}
FLEXURA_INLINE Wide larger(const Wide& a, const Wide& b) { return choose(a > b, a, b); }
FLEXURA_INLINE Wide size_of(const Wide& a) { return choose(a < 0, -a, a); }
// max(low, v), and low where v is not a number.
FLEXURA_INLINE Wide at_least(float low, const Wide& v) {
  return {at_least(low, v.low), at_least(low, v.high)};
}
FLEXURA_INLINE Wide square_root(const Wide& v) { return {square_root(v.low), square_root(v.high)}; }

FLEXURA_INLINE Wide wide_load(const float* from) { return {load(from), load(from + lanes)}; }
FLEXURA_INLINE void store(float* to, const Wide& v) { store(to, v.low), store(to + lanes, v.high); }
FLEXURA_INLINE Wide counted() {
  Wide count;
  for (std::size_t i = 0; i < lanes; ++i) count.low[i] = static_cast<float>(i);
  count.high = count.low + static_cast<float>(lanes);
  return count;
}

FLEXURA_INLINE std::uint32_t bits_of(const WideMask::Half& mask) {
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
// One a lane, the first one lowest.
FLEXURA_INLINE std::uint32_t bits_of(const WideMask& mask) {
  return bits_of(mask.low) | bits_of(mask.high) << lanes;
}
FLEXURA_INLINE bool any(const WideMask& mask) { return bits_of(mask.low | mask.high) != 0; }

// Sets `flag` in the bytes whose lanes are set.
FLEXURA_INLINE void set_flag(const WideMask& mask, std::uint8_t flag, std::uint8_t* bytes) {
  set_flag(reinterpret_cast<Words>(mask.low), flag, bytes);
  set_flag(reinterpret_cast<Words>(mask.high), flag, bytes + lanes);
}
// Whether the bytes have the flag.
FLEXURA_INLINE WideMask has_flag(const std::uint8_t* bytes, std::uint8_t flag) {
  return {(words_of(bytes) & flag) != 0, (words_of(bytes + lanes) & flag) != 0};
}
#undef FLEXURA_INLINE

}  // namespace
}  // namespace flexura
