#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/camera/sensor.h"
#include "flexura/math/simd_path.h"
#include "flexura/render/gamma_table.h"
#include "flexura/render/sensor_kernels.h"

namespace flexura {

/// What the noise of an image depends on, beside the pixel and the channel: the same stream gives the same
/// noise, any other one independent noise.
struct NoiseStream {
  std::uint64_t seed = 0;    ///< Of the run.
  std::uint64_t camera = 0;  ///< Its place among the cameras.
  std::uint64_t frame = 0;   ///< Its number.
};

/// What a sensor works on, row by row; reused, it allocates no more. One for each thread.
struct SensorRows {
  std::vector<float> left, right;  ///< Light at a row's ends, with what continues it.
  std::vector<float> conditioned;  ///< As many rows as the PSF needs at a time, and one more.
  std::vector<std::uint8_t> same;  ///< SameAs of their blocks.
  std::vector<std::uint8_t> age;   ///< By block: so many of the last rows were equal to the one before them.
  std::vector<std::uint8_t> is_plain, is_even, is_known, is_needed;  ///< Of the row under way, by block.
  std::vector<BlockWork> work;                                       ///< By block.
  std::vector<const float*> window;  ///< The rows that the PSF takes for this one, in their order.
  std::vector<float> light, levels;  ///< Of the row under way, up to whole blocks.
  std::vector<std::uint8_t> bytes;   ///< Likewise, of sensors of up to 8 bits.
};

/// A sensor ready to turn light into the numbers that a camera delivers. In physical order, for each value:
///
/// 1. Light that is negative or not a number counts as 0, and beyond 2^20 as 2^20.
/// 2. Vignetting: times 1 - vignetting (r/R)^2, r from the middle of the image, R the corner pixel's.
/// 3. PSF: a Gaussian along columns and rows, cut at 3.5 standard deviations, of unit sum and just the
///    variance asked for; beyond the image its edge goes on. What is flat stays exactly as it is.
/// 4. Shot noise: normal, of the variance light / full_well (Poisson's for many electrons); times gain.
/// 5. Read noise: normal.
/// 6. Cut to [0, 1], to the power 1/gamma, times 2^bits - 1, rounded half up.
///
/// A value's noise is a function of the stream, the pixel and the channel, so that images are the same for
/// any number of threads and on every SimdPath.
class Sensor {
 public:
  /// std::invalid_argument: a size below 1 or above 2^20, a PSF above 30 px, bits other than 1 to 16, a
  /// negative or infinite strength, a gain or gamma that is not positive; a path that is not available.
  explicit Sensor(const SensorConfig& config, SimdPath path = best_simd_path());

  [[nodiscard]] const SensorConfig& config() const { return config_; }

  /// The image of `light`, which is in units of full scale and of the sensor's size and channels. Bytes come
  /// from sensors of up to 8 bits, 16-bit words from those of more. std::invalid_argument: another size or
  /// type.
  template <typename Value>
  void read(const Image<float>& light, const NoiseStream& stream, SensorRows& rows,
            Image<Value>& image) const;

  /// Rows [first, last) of it alone, into an image of the right size: one thread's part. The
  /// same errors; and std::invalid_argument for rows that are not there.
  template <typename Value>
  void read_rows(const Image<float>& light, const NoiseStream& stream, int first, int last, SensorRows& rows,
                 Image<Value>& image) const;

 private:
  void reserve(SensorRows& rows) const;
  [[nodiscard]] std::size_t slot(int v) const;
  void take(const Image<float>& light, int v, bool is_first, SensorRows& rows) const;
  void plan(int v, SensorRows& rows) const;
  [[nodiscard]] SensorRow row(std::size_t blocks) const;
  [[nodiscard]] float lost(int x, int n) const;
  const float* blur_down(int v, SensorRows& rows) const;
  template <typename Value>
  void deliver(int v, const NoiseStream& stream, SensorRows& rows, Value* to) const;
  template <typename Value>
  void require_fit(const Image<float>& light, const Image<Value>& image) const;

  SensorConfig config_;
  const SensorKernels* kernels_;
  int width_, height_, radius_ = 0;
  std::vector<float> weights_;
  std::size_t channels_, count_, values_;  // A pixel's values, a row's, a block's.
  std::size_t margin_, blocks_;            // Blocks that continue a row at each end; with them and the row's.
  std::vector<float> lost_across_;         // Of vignetting, by value.
  SensorLevels levels_;
  GammaTable gamma_;
};

}  // namespace flexura
