#pragma once

#include <cstddef>
#include <cstdint>

// Sensor functions that are compiled for each instruction set (kernels.h).
namespace flexura {

/// Number of pixels in a block, processed together. Rows are padded to whole blocks.
constexpr std::size_t sensor_block = 32;

/// Conversion of light to a level: light * scale + offset, with noise of the variance light * shot + read,
/// clamped to [0, top].
struct SensorLevels {
  float scale = 1, offset = 0, shot = 0, read = 0, top = 1;
  bool is_noisy = false;
};

/// Noise of one row: a value's deviate depends on this key and its position in the row alone.
struct NoiseRow {
  std::uint32_t start = 0, mix = 0;
};

/// A row of light in the sensor.
struct SensorRow {
  std::size_t blocks = 0;
  const float* weights = nullptr;  ///< Weights of the PSF, nearest pixel first, without the middle one.
  std::size_t radius = 0;          ///< Number of weights.
  std::size_t channels = 1;
};

/// Neighbours to which a block is equal bit for bit.
enum SameAs : unsigned char { same_as_left = 1, same_as_above = 2 };

/// Work for a block of a row; avoids recomputing known results.
enum class BlockWork : unsigned char {
  none,  ///< Not needed.
  copy,  ///< All rows that are blurred into it are equal.
  blur,
};

/// Functions of one instruction set.
struct SensorKernels {
  /// to = from, clamped to [0, largest light] (NaN counts as 0), times 1 - (across + down) unless `across` is
  /// null. `above` is the result of the previous row; `has_left`: a block precedes `to`.
  void (*condition)(const SensorRow& row, const float* from, const float* across, float down,
                    const float* above, bool has_left, float* to, unsigned char* same);
  /// Blurs across 2 * radius + 1 rows, `rows[radius]` in the middle.
  void (*blur_down)(const SensorRow& row, const float* const* rows, const BlockWork* work, float* to);
  /// Blurs `light` along the row as far as there are weights, and computes its levels, unrounded or truncated
  /// to integers. Where `is_known[block]`, the light and all that is blurred into it equal those of the
  /// previous block and are not read.
  void (*to_levels)(const SensorRow& row, const float* light, const unsigned char* is_known,
                    const SensorLevels& levels, NoiseRow noise, float* to);
  void (*to_bytes)(const SensorRow& row, const float* light, const unsigned char* is_known,
                   const SensorLevels& levels, NoiseRow noise, std::uint8_t* to);
};

}  // namespace flexura
