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

/// Identifies the noise of an image. The noise of a pixel value depends only on the stream, the pixel and the
/// channel. Equal streams give equal noise. Different streams give independent noise.
struct NoiseStream {
  std::uint64_t seed = 0;    ///< Seed of the run.
  std::uint64_t camera = 0;  ///< Index of the camera.
  std::uint64_t frame = 0;   ///< Number of the frame.
};

/// Reusable working memory of a sensor; each thread needs its own. After the first use, no more memory is
/// allocated.
struct SensorRows {
  std::vector<float> left, right;  ///< Light at a row's ends, continued beyond the image's edge.
  std::vector<float>
      conditioned;  ///< Rows after clamping and vignetting: as many as the PSF combines, plus one.
  std::vector<std::uint8_t> same;  ///< SameAs flags of the blocks in the rows of `conditioned`.
  std::vector<std::uint8_t>
      /// For each block, the number of successive rows, up to the last row, that equal their previous row.
      age;
  /// State of each block of the current row.
  std::vector<std::uint8_t> is_plain, is_even, is_known, is_needed;
  std::vector<BlockWork> work;       ///< Work for each block.
  std::vector<const float*> window;  ///< Rows that the PSF combines for the current row, in order.
  /// Light and levels of the current row. The length of both arrays is rounded up to whole blocks.
  std::vector<float> light, levels;
  std::vector<std::uint8_t> bytes;  ///< Levels of the current row, for sensors of up to 8 bits.
};

/// An image sensor, which converts light to pixel values. The steps for each value are, in physical order:
///
/// - Clamping: light that is negative or NaN counts as 0. Light above 2^20 counts as 2^20.
/// - Vignetting: multiplication by 1 - vignetting (r/R)^2. Here r is the distance from the image's middle,
///   and R is the distance of the corner pixels from this middle.
/// - PSF: convolution with a Gaussian along columns and rows, cut at 3.5 standard deviations. The kernel has
///   unit sum and exactly the configured variance. Outside the image, the pixels of its edge are repeated.
///   Uniform areas remain exactly unchanged.
/// - Shot noise: normally distributed with the variance light / full_well (Poisson distribution for many
///   electrons).
/// - Gain: multiplication by the gain.
/// - Read noise: normally distributed.
/// - Quantisation: clamping to [0, 1], power 1/gamma, multiplication by 2^bits - 1, rounding half up.
///
/// Noise depends only on the stream, the pixel and the channel. Hence images are equal for any number of
/// threads and any instruction set.
class Sensor {
 public:
  /// Throws std::invalid_argument for a size below 1 or above 2^20, a PSF above 30 px, or bits outside 1 to
  /// 16. Also throws std::invalid_argument for a negative or infinite strength of an effect, and for a gain
  /// or gamma that is not positive. The same exception is thrown for an instruction set that the processor
  /// does not support.
  explicit Sensor(const SensorConfig& config, SimdPath path = best_simd_path());

  [[nodiscard]] const SensorConfig& config() const { return config_; }

  /// Computes the image of `light`, which is in units of full scale and has the sensor's size and channels.
  /// Values have 8 bits for sensors with up to 8 bits, otherwise 16 bits. Throws std::invalid_argument for a
  /// wrong size or type.
  template <typename Value>
  void read(const Image<float>& light, const NoiseStream& stream, SensorRows& rows,
            Image<Value>& image) const;

  /// Computes only the rows [first, last) of the image, for example those of one thread. The image must
  /// already have the right size. Throws the exceptions of read(), and std::invalid_argument for rows outside
  /// the image.
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
  std::size_t channels_, count_, values_;  // Numbers of values per pixel, per row and per block.
  // Number of blocks that continue a row at each end; number of blocks including these.
  std::size_t margin_, blocks_;
  std::vector<float> lost_across_;  // Fraction of light lost by vignetting across a row, for each value.
  SensorLevels levels_;
  GammaTable gamma_;
};

}  // namespace flexura
