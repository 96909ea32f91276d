#pragma once

#include <cstddef>
#include <cstdint>

// What the sources compiled for one instruction set each (sensor_*.cc) offer to sensor_image.cc. They include
// nothing of the project but this and sensor_lanes.h: an inline function of a header that others include too
// could be compiled for AVX there, and the linker could pick that copy for everybody.
namespace flexura {

enum class SimdPath;

/// Values that the kernels take at a time. Rows are padded to a multiple of it times the channels.
constexpr std::size_t sensor_block = 32;

/// How light becomes a level: light * scale + offset, with noise of the variance light * shot + read, cut to
/// [0, top].
struct SensorLevels {
  float scale = 1, offset = 0, shot = 0, read = 0, top = 1;
  bool is_noisy = false;
};

/// Noise of one row: a value's deviate depends on this key and its place in the row alone.
struct NoiseRow {
  std::uint32_t start, mix;
};

/// One instruction set's functions. `count` is a multiple of sensor_block * channels.
struct SensorKernels {
  /// to = from, between 0 and the largest light (what is not a number counts as 0), times 1 - (across + down)
  /// unless `across` is null.
  void (*condition)(const float* from, const float* across, float down, float* to, std::size_t count);
  /// Blurs along the row: taps lie `channels` apart, `radius` of them (weights[0] the nearest) on each side.
  /// `from` can be read radius * channels values beyond both ends.
  void (*blur_across)(const float* from, float* to, std::size_t count, std::size_t channels,
                      const float* weights, std::size_t radius);
  /// Blurs across 2 * radius + 1 rows, `rows[radius]` in the middle. Where `is_same[block]` they are all
  /// equal and the middle one is copied.
  void (*blur_down)(const float* const* rows, float* to, std::size_t count, std::size_t channels,
                    const float* weights, std::size_t radius, const unsigned char* is_same);
  /// is_equal[block] = whether the rows' values are.
  void (*compare)(const float* a, const float* b, std::size_t count, std::size_t channels,
                  unsigned char* is_equal);
  /// Levels of a row.
  void (*levels)(const float* light, float* to, std::size_t count, std::size_t channels,
                 const SensorLevels& levels, NoiseRow noise);
  void (*to_bytes)(const float* from, std::uint8_t* to, std::size_t count);
  void (*to_words)(const float* from, std::uint16_t* to, std::size_t count);
};

const SensorKernels* baseline_sensor_kernels();
// None where the compiler did not build for the set.
const SensorKernels* avx2_sensor_kernels();
const SensorKernels* avx512_sensor_kernels();

}  // namespace flexura
