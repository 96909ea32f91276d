#pragma once

#include <cstddef>
#include <cstdint>

#include "flexura/render/sensor_kernels.h"
#include "flexura/render/vectors.h"

// Arithmetic of the sensor; only all_kernels.h includes this header.
namespace flexura {
namespace {

// Limits that keep all numbers finite. Levels at these limits are far above full scale, even with noise.
constexpr float largest_light = 1048576, largest_level = 16777216, largest_deviation = 1048576;

// Number of vectors processed together. Independent vectors fill the time in which an operation waits for its
// predecessor.
constexpr std::size_t in_step = vector_bytes == 64 ? 2 : 4, step_values = in_step * lanes;
static_assert(sensor_block % step_values == 0);

struct Step {
  Floats v[in_step] = {};
};
template <typename Body>
[[gnu::always_inline]] inline void each(Body&& body) {
  for (std::size_t j = 0; j < in_step; ++j) body(j);
}

// Returns the bits in which two vectors differ.
[[gnu::always_inline]] inline Words difference(const Floats& a, const Floats& b) {
  return reinterpret_cast<Words>(a) ^ reinterpret_cast<Words>(b);
}

void condition(const SensorRow& row, const float* from, const float* across, float down, const float* above,
               bool has_left, float* to, unsigned char* same) {
  const std::size_t values = sensor_block * row.channels;
  for (std::size_t block = 0; block < row.blocks; ++block) {
    const bool is_first = block == 0 && !has_left;
    const float* const left = is_first ? to : to - values;
    Words from_left = {}, from_above = {};
    for (std::size_t c = 0; c < row.channels; ++c) {
      for (std::size_t j = 0; j < sensor_block; j += lanes) {
        const std::size_t i = c * sensor_block + j;
        Floats light = at_most(largest_light, at_least(0, load(from + i)));
        if (across != nullptr) light *= 1 - (load(across + i) + down);
        from_left |= difference(light, load(left + i));
        from_above |= difference(light, load(above + i));
        store(to + i, light);
      }
    }
    same[block] = static_cast<unsigned char>((is_first || bits_of(from_left != 0) != 0 ? 0 : same_as_left) |
                                             (bits_of(from_above != 0) != 0 ? 0 : same_as_above));
    from += values, above += values, to += values;
    if (across != nullptr) across += values;
  }
}

// Returns the middle value plus weighted differences from the middle value. The differences are exactly 0 if
// all values are equal, so that uniform blocks can be skipped. `before` and `after` return the positions of
// the taps at a distance.
template <typename Before, typename After>
[[gnu::always_inline]] inline Step blurred(const float* middle, const SensorRow& row, Before&& before,
                                           After&& after) {
  Step sum, twice;
  each([&](std::size_t j) { sum.v[j] = load(middle + j * lanes); });
  each([&](std::size_t j) { twice.v[j] = sum.v[j] + sum.v[j]; });
  for (std::size_t tap = 1; tap <= row.radius; ++tap) {
    const float *one = before(tap), *other = after(tap), weight = row.weights[tap - 1];
    each([&](std::size_t j) {
      sum.v[j] += weight * ((load(one + j * lanes) + load(other + j * lanes)) - twice.v[j]);
    });
  }
  return sum;
}

void blur_down(const SensorRow& row, const float* const* rows, const BlockWork* work, float* to) {
  const std::size_t values = sensor_block * row.channels;
  for (std::size_t block = 0; block < row.blocks; ++block) {
    if (work[block] == BlockWork::none) continue;
    for (std::size_t i = block * values; i < (block + 1) * values; i += step_values) {
      const float* const middle = rows[row.radius] + i;
      if (work[block] == BlockWork::copy) {
        __builtin_memcpy(to + i, middle, step_values * sizeof(float));
        continue;
      }
      const Step sum = blurred(
          middle, row, [&](std::size_t tap) { return rows[row.radius - tap] + i; },
          [&](std::size_t tap) { return rows[row.radius + tap] + i; });
      each([&](std::size_t j) { store(to + i + j * lanes, sum.v[j]); });
    }
  }
}

// Levels without noise, and the standard deviations of the noise.
struct Expectation {
  float means[3 * sensor_block] = {}, deviations[3 * sensor_block] = {};
};

[[gnu::always_inline]] inline void expect(const Step& light, const SensorLevels& levels, std::size_t i,
                                          Expectation& expected) {
  each([&](std::size_t j) {
    const Floats mean = light.v[j] * levels.scale + levels.offset;
    store(expected.means + i + j * lanes, at_most(largest_level, mean));
    const Floats variance = light.v[j] * levels.shot + levels.read;
    store(expected.deviations + i + j * lanes,
          at_most(largest_deviation, square_root(at_least(0, variance))));
  });
}

// Computes the expectation of a block whose light is blurred along the row.
template <std::size_t channels>
void expect_block(const SensorRow& row, const float* light, const SensorLevels& levels,
                  Expectation& expected) {
  for (std::size_t i = 0; i < sensor_block * channels; i += step_values) {
    const float* const middle = light + i;
    const Step sum = blurred(
        middle, row, [&](std::size_t tap) { return middle - tap * channels; },
        [&](std::size_t tap) { return middle + tap * channels; });
    expect(sum, levels, i, expected);
  }
}

// Constants for a standard normal deviate computed from the weighted sum of a word's bytes, which is nearly
// normal. An odd polynomial, fitted up to 4.6 standard deviations, maps the quantiles of the sum's
// distribution to normal quantiles. The resulting distribution has variance 1 and fourth moment 2.998. Its
// probabilities beyond 1, 2, 3 and 4 standard deviations have relative errors of 0.4, 0.2, 0.8 and 7 %; its
// maximum is 5.04. The weights of the bytes are nearly equal but different, which gives seven million
// different sums instead of a thousand.
constexpr float sum_centre = 8 + 4096702.5f / 1048576;
constexpr float normal_terms[4] = {0.841045443f, 0.0172821804f, -0.00237808649f, 0.000207595845f};

// Factors of the hash of a value's position in its row: Wellons' lowbias32, with a key added before and
// within. The first step of lowbias32 is omitted, because it does not change numbers below 2^16. `places` are
// the positions times the first factor, plus a key.
constexpr std::uint32_t first_factor = 0x7feb352d, second_factor = 0x846ca68b;

[[gnu::always_inline]] inline Step noise_of(const Words& places, std::uint32_t mix) {
  Words x[in_step], shifted[in_step];
  each([&](std::size_t j) { x[j] = places + static_cast<std::uint32_t>(j * lanes) * first_factor; });
  each([&](std::size_t j) { shifted[j] = (x[j] >> 15) ^ mix; });
  each([&](std::size_t j) { x[j] = (x[j] ^ shifted[j]) * second_factor; });
  each([&](std::size_t j) { shifted[j] = x[j] >> 16; });
  each([&](std::size_t j) { x[j] = weighted_bytes(x[j] ^ shifted[j]); });
  Step y, z, sum;
  // Numbers below 2^23 fit into the low bits of a float from 8 to 16.
  each([&](std::size_t j) { y.v[j] = reinterpret_cast<Floats>(x[j] | 0x41000000u) - sum_centre; });
  each([&](std::size_t j) { z.v[j] = y.v[j] * y.v[j]; });
  each([&](std::size_t j) { sum.v[j] = z.v[j] * normal_terms[3] + normal_terms[2]; });
  each([&](std::size_t j) { sum.v[j] = sum.v[j] * z.v[j] + normal_terms[1]; });
  each([&](std::size_t j) { sum.v[j] = sum.v[j] * z.v[j] + normal_terms[0]; });
  each([&](std::size_t j) { sum.v[j] = sum.v[j] * y.v[j]; });
  return sum;
}

[[gnu::always_inline]] inline void put(const Step& level, float top, float* to) {
  each([&](std::size_t j) { store(to + j * lanes, at_most(top, at_least(0, level.v[j]))); });
}
[[gnu::always_inline]] inline void put(const Step& level, float top, std::uint8_t* to) {
  if (top < 255) {
    Step cut;
    each([&](std::size_t j) { cut.v[j] = at_most(top, level.v[j]); });
    store_bytes(cut.v, to);
  } else {
    store_bytes(level.v, to);
  }
}

template <std::size_t channels, typename Value>
void deliver_blocks(const SensorRow& row, const float* light, const unsigned char* is_known,
                    const SensorLevels& levels, NoiseRow noise, Value* to) {
  constexpr std::size_t values = sensor_block * channels;
  Expectation expected;
  Words places;
  for (std::size_t j = 0; j < lanes; ++j)
    places[j] = noise.start + static_cast<std::uint32_t>(j) * first_factor;
  for (std::size_t block = 0; block < row.blocks; ++block) {
    if (is_known[block] == 0) expect_block<channels>(row, light + block * values, levels, expected);
    for (std::size_t i = 0; i < values; i += step_values) {
      Step level;
      each([&](std::size_t j) { level.v[j] = load(expected.means + i + j * lanes); });
      if (levels.is_noisy) {
        const Step deviate = noise_of(places, noise.mix);
        each([&](std::size_t j) { level.v[j] += deviate.v[j] * load(expected.deviations + i + j * lanes); });
        places += static_cast<std::uint32_t>(step_values) * first_factor;
      }
      put(level, levels.top, to + block * values + i);
    }
  }
}

template <typename Value>
void deliver(const SensorRow& row, const float* light, const unsigned char* is_known,
             const SensorLevels& levels, NoiseRow noise, Value* to) {
  const auto blocks = row.channels == 1 ? deliver_blocks<1, Value> : deliver_blocks<3, Value>;
  blocks(row, light, is_known, levels, noise, to);
}

}  // namespace
}  // namespace flexura
