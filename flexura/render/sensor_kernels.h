#pragma once

#include <cstddef>
#include <cstdint>

// What is worked out for the sensor in each instruction set (kernels.h).
namespace flexura {

/// Pixels that the kernels take at a time: a block. Rows are padded to whole ones.
constexpr std::size_t sensor_block = 32;

/// How light becomes a level: light * scale + offset, with noise of the variance light * shot + read, cut to
/// [0, top].
struct SensorLevels {
  float scale = 1, offset = 0, shot = 0, read = 0, top = 1;
  bool is_noisy = false;
};

/// Noise of one row: a value's deviate depends on this key and its place in the row alone.
struct NoiseRow {
  std::uint32_t start = 0, mix = 0;
};

/// A row of light on its way through the sensor.
struct SensorRow {
  std::size_t blocks = 0;
  const float* weights = nullptr;  ///< Of the PSF: the nearest pixel's first, without the middle one.
  std::size_t radius = 0;          ///< Their number.
  std::size_t channels = 1;
};

/// What a block is equal to, bit for bit.
enum SameAs : unsigned char { same_as_left = 1, same_as_above = 2 };

/// What is done with a block of a row, so that what is known already is not worked out again.
enum class BlockWork : unsigned char {
  none,  ///< Nobody looks at it.
  copy,  ///< All rows that are blurred into it are equal.
  blur,
};

/// One instruction set's functions.
struct SensorKernels {
  /// to = from, between 0 and the largest light (what is not a number counts as 0), times 1 - (across + down)
  /// unless `across` is null. `above` is what came out for the row before; `has_left` says that a block
  /// stands before `to`.
  void (*condition)(const SensorRow& row, const float* from, const float* across, float down,
                    const float* above, bool has_left, float* to, unsigned char* same);
  /// Blurs across 2 * radius + 1 rows, `rows[radius]` in the middle.
  void (*blur_down)(const SensorRow& row, const float* const* rows, const BlockWork* work, float* to);
  /// Blurs `light` along the row, as far as there are weights, and gives its levels, as they are or cut to
  /// whole numbers. Where `is_known[block]` the light and what is blurred into it are as they were a block
  /// before, and are not looked at.
  void (*to_levels)(const SensorRow& row, const float* light, const unsigned char* is_known,
                    const SensorLevels& levels, NoiseRow noise, float* to);
  void (*to_bytes)(const SensorRow& row, const float* light, const unsigned char* is_known,
                   const SensorLevels& levels, NoiseRow noise, std::uint8_t* to);
};

}  // namespace flexura
