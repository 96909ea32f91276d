#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#include <cstddef>
#include <cstdint>

#include "flexura/render/sensor_kernels.h"

// The sensor's arithmetic, for sensor_*.cc alone. Loops over plain arrays are left to the compiler to
// vectorize; the noise is written with its vectors (GCC's extensions, which clang has too). Every operation
// works on each value by itself and rounds once, so that the width changes no bit.
//
// All is in an unnamed namespace: each source has its own copy, compiled for its own instruction set.
namespace flexura {
namespace {

// Light beyond this is cut off, so that the blur of it stays finite.
constexpr float largest_light = 1048576;

void condition(const float* from, const float* across, float down, float* to, std::size_t count) {
  const auto clamped = [](float light) {
    const float positive = light > 0 ? light : 0;
    return positive < largest_light ? positive : largest_light;
  };
  if (across == nullptr) {
    for (std::size_t i = 0; i < count; ++i) to[i] = clamped(from[i]);
  } else {
    for (std::size_t i = 0; i < count; ++i) to[i] = clamped(from[i]) * (1 - (across[i] + down));
  }
}

// Whether a[i] and b[i] have the same bits for all i < count (a multiple of 8).
bool same_bits(const float* a, const float* b, std::size_t count) {
  using Bits = std::uint32_t __attribute__((vector_size(32)));
  Bits differences = {};
  for (std::size_t i = 0; i < count; i += 8) {
    Bits u, v;
    __builtin_memcpy(&u, a + i, sizeof u);
    __builtin_memcpy(&v, b + i, sizeof v);
    differences |= u ^ v;
  }
  std::uint64_t parts[4];
  __builtin_memcpy(parts, &differences, sizeof parts);
  return (parts[0] | parts[1] | parts[2] | parts[3]) == 0;
}

// The middle value plus the weighted differences from it: exact where all are equal, so that such blocks may
// as well be copied.
void blur_across(const float* from, float* to, std::size_t count, std::size_t channels, const float* weights,
                 std::size_t radius) {
  const std::size_t block = sensor_block * channels, reach = radius * channels;
  // Compared in whole eights; the row can be read that far.
  const std::size_t compared = (block + 2 * reach - channels + 7) / 8 * 8;
  for (std::size_t begin = 0; begin < count; begin += block) {
    const float* first = from + begin - reach;
    if (same_bits(first, first + channels, compared)) {
      __builtin_memcpy(to + begin, from + begin, block * sizeof(float));
      continue;
    }
    for (std::size_t start = begin; start < begin + block; start += sensor_block) {
      const float* middle = from + start;
      float sums[sensor_block];
      for (std::size_t i = 0; i < sensor_block; ++i) sums[i] = middle[i];
      for (std::size_t tap = 1; tap <= radius; ++tap) {
        const float *left = middle - tap * channels, *right = middle + tap * channels;
        const float weight = weights[tap - 1];
        for (std::size_t i = 0; i < sensor_block; ++i)
          sums[i] += weight * ((left[i] - middle[i]) + (right[i] - middle[i]));
      }
      __builtin_memcpy(to + start, sums, sizeof sums);
    }
  }
}

void blur_down(const float* const* rows, float* to, std::size_t count, std::size_t channels,
               const float* weights, std::size_t radius, const unsigned char* is_same) {
  const std::size_t block = sensor_block * channels;
  for (std::size_t begin = 0; begin < count; begin += block) {
    if (is_same[begin / block] != 0) {
      __builtin_memcpy(to + begin, rows[radius] + begin, block * sizeof(float));
      continue;
    }
    for (std::size_t start = begin; start < begin + block; start += sensor_block) {
      const float* middle = rows[radius] + start;
      float sums[sensor_block];
      for (std::size_t i = 0; i < sensor_block; ++i) sums[i] = middle[i];
      for (std::size_t tap = 1; tap <= radius; ++tap) {
        const float *above = rows[radius - tap] + start, *below = rows[radius + tap] + start;
        const float weight = weights[tap - 1];
        for (std::size_t i = 0; i < sensor_block; ++i)
          sums[i] += weight * ((above[i] - middle[i]) + (below[i] - middle[i]));
      }
      __builtin_memcpy(to + start, sums, sizeof sums);
    }
  }
}

void compare(const float* a, const float* b, std::size_t count, std::size_t channels,
             unsigned char* is_equal) {
  const std::size_t block = sensor_block * channels;
  for (std::size_t begin = 0; begin < count; begin += block)
    is_equal[begin / block] = same_bits(a + begin, b + begin, block) ? 1 : 0;
}

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

// The sum of a word's four bytes, weighted with 64 * 128, 63 * 128, 64 * 125 and 63 * 125 from the lowest on:
// nearly equal, but different enough to give seven million sums instead of a thousand. Below 2^23.
Words sum_of_bytes(Words x) {
#if defined(__AVX512BW__)
  const __m512i pairs = _mm512_maddubs_epi16(reinterpret_cast<__m512i>(x), _mm512_set1_epi16(64 | 63 << 8));
  return reinterpret_cast<Words>(_mm512_madd_epi16(pairs, _mm512_set1_epi32(128 | 125 << 16)));
#elif defined(__AVX2__)
  const __m256i pairs = _mm256_maddubs_epi16(reinterpret_cast<__m256i>(x), _mm256_set1_epi16(64 | 63 << 8));
  return reinterpret_cast<Words>(_mm256_madd_epi16(pairs, _mm256_set1_epi32(128 | 125 << 16)));
#else
  // Two bytes' weighted sum stays below 2^16, so that both halves of a word hold one.
  const Words pairs = (x & 0x00ff00ffu) * 64 + ((x >> 8) & 0x00ff00ffu) * 63;
  return (pairs & 0xffffu) * 128 + (pairs >> 16) * 125;
#endif
}

// A hash of a value's place in its row (C. Wellons' lowbias32, whose first step does nothing to a number
// below 2^16), keyed before and within. `places` is the place times its first factor.
constexpr std::uint32_t first_factor = 0x7feb352d, second_factor = 0x846ca68b;

// A standard normal deviate from the sum of a word's bytes, itself nearly normal: an odd polynomial that
// takes quantiles of the sum's distribution to those of the normal one, fitted up to 4.6 standard deviations.
// The sum's exact distribution then has variance 1, fourth moment 2.998, and probabilities beyond 1, 2, 3 and
// 4 right to 0.2, 0.2, 0.8 and 7 %; at most 5.04.
constexpr float centre = 8 + 4096702.5f / 1048576;
constexpr float normal_terms[4] = {0.841045443f, 0.0172821804f, -0.00237808649f, 0.000207595845f};

// N vectors in step: what is computed waits for what was computed just before; the others' work fills the
// time.
template <std::size_t n>
[[gnu::always_inline]] inline void add_noise(const float* means, const float* deviations, float top,
                                             std::uint32_t mix, Words places, float* to) {
  Words x[n], t[n];
  Floats y[n], z[n];
  const auto each = [](auto&& step) {
    for (std::size_t j = 0; j < n; ++j) step(j);
  };
  each([&](std::size_t j) { x[j] = places + static_cast<std::uint32_t>(j * lanes) * first_factor; });
  each([&](std::size_t j) { t[j] = x[j] >> 15; });
  each([&](std::size_t j) { x[j] ^= t[j]; });
  each([&](std::size_t j) { x[j] ^= mix; });
  each([&](std::size_t j) { x[j] *= second_factor; });
  each([&](std::size_t j) { t[j] = x[j] >> 16; });
  each([&](std::size_t j) { x[j] ^= t[j]; });
  each([&](std::size_t j) { x[j] = sum_of_bytes(x[j]); });
  // As the low bits of a float from 8 to 16.
  each([&](std::size_t j) { y[j] = reinterpret_cast<Floats>(x[j] | 0x41000000u) - centre; });
  each([&](std::size_t j) { z[j] = y[j] * y[j]; });
  Floats sum[n];
  each([&](std::size_t j) { sum[j] = z[j] * normal_terms[3] + normal_terms[2]; });
  each([&](std::size_t j) { sum[j] = sum[j] * z[j] + normal_terms[1]; });
  each([&](std::size_t j) { sum[j] = sum[j] * z[j] + normal_terms[0]; });
  each([&](std::size_t j) {
    Floats mean, deviation;
    __builtin_memcpy(&mean, means + j * lanes, sizeof mean);
    __builtin_memcpy(&deviation, deviations + j * lanes, sizeof deviation);
    Floats level = mean + (sum[j] * y[j]) * deviation;
    level = level > 0 ? level : Floats{};
    level = level < top ? level : Floats{} + top;
    __builtin_memcpy(to + j * lanes, &level, sizeof level);
  });
}

// What does not depend on the place: the level without noise, and the noise's standard deviation.
void expectation(const float* light, std::size_t count, const SensorLevels& levels, float* means,
                 float* deviations) {
  for (std::size_t i = 0; i < count; ++i) means[i] = light[i] * levels.scale + levels.offset;
  for (std::size_t i = 0; i < count; ++i) {
    const float variance = light[i] * levels.shot + levels.read;
    deviations[i] = __builtin_sqrtf(variance > 0 ? variance : 0);
  }
}

void cut(const float* means, float top, float* to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const float positive = means[i] > 0 ? means[i] : 0;
    to[i] = positive < top ? positive : top;
  }
}

// Where the light is the block's before, so are the expectations.
void levels_of(const float* light, float* to, std::size_t count, std::size_t channels,
               const SensorLevels& levels, NoiseRow noise) {
  constexpr std::size_t in_step = vector_bytes == 64 ? 2 : 4, step = in_step * lanes;
  const std::size_t block = sensor_block * channels;
  float means[3 * sensor_block], deviations[3 * sensor_block];
  Words places;
  for (std::size_t j = 0; j < lanes; ++j)
    places[j] = noise.start + static_cast<std::uint32_t>(j) * first_factor;
  for (std::size_t begin = 0; begin < count; begin += block) {
    if (begin == 0 || !same_bits(light + begin, light + begin - block, block))
      expectation(light + begin, block, levels, means, deviations);
    if (!levels.is_noisy) {
      cut(means, levels.top, to + begin, block);
      continue;
    }
    for (std::size_t i = 0; i < block; i += step) {
      add_noise<in_step>(means + i, deviations + i, levels.top, noise.mix, places, to + begin + i);
      places += static_cast<std::uint32_t>(step) * first_factor;
    }
  }
}

void to_bytes(const float* from, std::uint8_t* to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<std::uint8_t>(static_cast<int>(from[i]));
}
void to_words(const float* from, std::uint16_t* to, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<std::uint16_t>(static_cast<int>(from[i]));
}

constexpr SensorKernels sensor_kernels = {condition, blur_across, blur_down, compare,
                                          levels_of, to_bytes,    to_words};

}  // namespace
}  // namespace flexura
