#pragma once

#include <cstddef>
#include <cstdint>

// Sensor functions that are compiled for each instruction set (kernels.h).
namespace flexura {

/// Number of pixels in a block, which is processed as a unit. Rows are padded to whole blocks.
constexpr std::size_t sensor_block = 32;

/// Conversion of light to a level: light * scale + offset, plus noise of variance light * shot + read,
/// clamped to [0, top].
struct SensorLevels {
  float scale = 1, offset = 0, shot = 0, read = 0, top = 1;
  bool is_noisy = false;
};

/// Key of the random generator for the noise of one row. The noise of a value depends only on this key and on
/// the value's position in the row.
struct NoiseRow {
  std::uint32_t start = 0, mix = 0;
};

/// Properties of a row of light in the sensor.
struct SensorRow {
  std::size_t blocks = 0;
  /// Weights of one side of the PSF, nearest pixel first, without the middle weight.
  const float* weights = nullptr;
  std::size_t radius = 0;  ///< Number of these weights.
  std::size_t channels = 1;
};

/// Flags for the neighbours to which a block is bitwise equal.
enum SameAs : unsigned char { same_as_left = 1, same_as_above = 2 };

/// Work that a block of a row needs, to avoid recomputing known results.
enum class BlockWork : unsigned char {
  none,  ///< The block is not needed.
  copy,  ///< All rows that are blurred into the block are equal. One of these rows is copied.
  blur,
};

/// Functions of one instruction set.
struct SensorKernels {
  /// Clamps light to [0, largest light], where NaN counts as 0, and multiplies it by 1 - (across + down)
  /// unless `across` is null. `above` is the result of the previous row. `has_left`: whether a block precedes
  /// `to`. Writes the SameAs flags to `same`.
  void (*condition)(const SensorRow& row, const float* from, const float* across, float down,
                    const float* above, bool has_left, float* to, unsigned char* same);
  /// Blurs across 2 * radius + 1 rows, of which `rows[radius]` is the middle.
  void (*blur_down)(const SensorRow& row, const float* const* rows, const BlockWork* work, float* to);
  /// Blurs `light` along the row if there are weights, and computes levels, unrounded or truncated to
  /// integers. If `is_known[block]`, the result equals the result of the previous block, and the block's
  /// light is not read.
  void (*to_levels)(const SensorRow& row, const float* light, const unsigned char* is_known,
                    const SensorLevels& levels, NoiseRow noise, float* to);
  void (*to_bytes)(const SensorRow& row, const float* light, const unsigned char* is_known,
                   const SensorLevels& levels, NoiseRow noise, std::uint8_t* to);
};

}  // namespace flexura
