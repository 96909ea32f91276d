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

/// Determines the noise of an image together with the pixel and the channel: equal streams give equal noise,
/// different ones independent noise.
struct NoiseStream {
  std::uint64_t seed = 0;    ///< Seed of the run.
  std::uint64_t camera = 0;  ///< Index of the camera.
  std::uint64_t frame = 0;   ///< Number of the frame.
};

/// Reusable working memory of a sensor; after the first use it allocates nothing more. One per thread.
struct SensorRows {
  std::vector<float> left, right;  ///< Light at a row's ends, with its continuation.
  std::vector<float> conditioned;  ///< Conditioned rows: as many as the PSF needs at a time, plus one.
  std::vector<std::uint8_t> same;  ///< SameAs of the blocks of these rows.
  std::vector<std::uint8_t> age;   ///< By block: how many of the last rows were equal to their predecessor.
  /// State of each block of the present row.
  std::vector<std::uint8_t> is_plain, is_even, is_known, is_needed;
  std::vector<BlockWork> work;       ///< Work for each block.
  std::vector<const float*> window;  ///< The rows that the PSF combines for the present one, in order.
  std::vector<float> light, levels;  ///< Light and levels of the present row, rounded up to whole blocks.
  std::vector<std::uint8_t> bytes;   ///< Levels of the present row for sensors of up to 8 bits.
};

/// A sensor that converts light into the values that a camera delivers. In physical order, for each value:
///
/// 1. Light that is negative or NaN counts as 0, and beyond 2^20 as 2^20.
/// 2. Vignetting: times 1 - vignetting (r/R)^2, r from the middle of the image, R the corner pixel's.
/// 3. PSF: a Gaussian along columns and rows, cut at 3.5 standard deviations, of unit sum and exactly the
///    configured variance; the image's edge is continued. Uniform areas stay exactly unchanged.
/// 4. Shot noise: normal, of the variance light / full_well (Poisson's for many electrons); times gain.
/// 5. Read noise: normal.
/// 6. Clamped to [0, 1], to the power 1/gamma, times 2^bits - 1, rounded half up.
///
/// The noise of a value is a function of the stream, the pixel and the channel. Images are therefore equal
/// for any number of threads and on every SimdPath.
class Sensor {
 public:
  /// Throws std::invalid_argument for a size below 1 or above 2^20, a PSF above 30 px, bits outside 1 to 16,
  /// or a negative or infinite strength. Also for a gain or gamma that is not positive, or a path that is not
  /// available.
  explicit Sensor(const SensorConfig& config, SimdPath path = best_simd_path());

  [[nodiscard]] const SensorConfig& config() const { return config_; }

  /// Computes the image of `light`, which is in units of full scale and has the sensor's size and channels.
  /// Sensors of up to 8 bits deliver bytes, others 16-bit words. Throws std::invalid_argument for another
  /// size or type.
  template <typename Value>
  void read(const Image<float>& light, const NoiseStream& stream, SensorRows& rows,
            Image<Value>& image) const;

  /// Computes only the rows [first, last) of it, in an image of the right size: one thread's part. Throws as
  /// read() does, also for rows outside the image.
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
  std::size_t channels_, count_, values_;  // Values per pixel, row and block.
  std::size_t margin_, blocks_;            // Blocks that continue a row at each end; with them and the row's.
  std::vector<float> lost_across_;         // By vignetting, by value.
  SensorLevels levels_;
  GammaTable gamma_;
};

}  // namespace flexura
