#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/image.h"

namespace flexura {

/// Method that chooses the threshold between foreground and background from the picture's histogram (paper,
/// section 3.4).
enum class ThresholdMethod {
  otsu,      ///< Maximizes the variance between the two classes (N. Otsu, 1979).
  two_mode,  ///< Takes the deepest valley between the histogram's two peaks.
  fixed,     ///< Takes ThresholdConfig::level.
  /// Applies Otsu's method to blocks of the picture, with linear interpolation between blocks; for screens
  /// with uneven brightness.
  by_block,
};
const std::vector<std::string>& names_of(const ThresholdMethod*);

/// Brightness of the foreground relative to the background.
enum class Figure { dark, bright };
const std::vector<std::string>& names_of(const Figure*);

/// Settings for the separation of foreground and background.
struct ThresholdConfig {
  ThresholdMethod method = ThresholdMethod::otsu;
  double level = 127.5;  ///< Threshold of the method `fixed`, on a scale from 0 to 255.
  std::optional<Figure>
      figure;      ///< Class of the foreground. Default: the class that is not at the picture's border.
  int block = 32;  ///< Side of a block for the method `by_block`, px.
};

/// Number of pixels of each brightness. For pictures with more than 8 bits, brightness is the upper 8 bits.
using Histogram = std::array<std::uint32_t, 256>;

/// Computes the histogram of a picture. If the picture has more than `samples` pixels, only pixels at equal
/// distances are counted.
[[nodiscard]] Histogram histogram_of(const Image<std::uint8_t>& gray, std::size_t samples = 1U << 30U);

/// A threshold, with statistics of the two classes. Brightness is on a scale from 0 to 255.
struct Threshold {
  ThresholdMethod method = ThresholdMethod::otsu;
  double level = 0;             ///< Threshold, half-way between two integers.
  double dark = 0, bright = 0;  ///< Mean brightness of each class.
  double mean = 0;              ///< Mean brightness of all pixels.
  double spread = 0;            ///< Standard deviation of brightness within the classes.
  Figure figure = Figure::dark;
  /// Reason why no foreground can be separated ("the picture is blank ..."); otherwise "".
  std::string reason;
};

/// Computes the threshold of a histogram by one of the methods otsu, two_mode and fixed. If no foreground can
/// be separated, Threshold::reason says why.
[[nodiscard]] Threshold threshold_of(const Histogram& histogram, const ThresholdConfig& config = {});

/// Computes the threshold of a picture, and which of the two classes is the foreground. `samples` limits the
/// number of pixels in the histogram.
[[nodiscard]] Threshold threshold_of(const Image<std::uint8_t>& gray, const ThresholdConfig& config,
                                     std::size_t samples = 1U << 30U);

/// Thresholds of the blocks of a picture.
class BlockThresholds {
 public:
  /// Computes the threshold of each block from a neighbourhood that grows until two classes can be separated.
  /// Blocks without such a neighbourhood are interpolated. Returns false if no block has a threshold.
  bool make(const Image<std::uint8_t>& gray, const ThresholdConfig& config);
  /// Returns the mean threshold of the blocks in which two classes can be separated. The `figure` of the
  /// result is the class that is not at the picture's border.
  [[nodiscard]] Threshold mean(const Image<std::uint8_t>& gray) const;
  /// Sets `levels` to the threshold at each pixel of row v, rounded up.
  void row(int v, std::vector<std::uint8_t>& levels) const;

 private:
  struct Block {
    double level = std::numeric_limits<double>::quiet_NaN(), dark = 0, bright = 0;
    double mean = 0;  // Mean brightness of the block's own pixels.

    [[nodiscard]] bool has_level() const { return !std::isnan(level); }
  };
  [[nodiscard]] std::size_t place(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  [[nodiscard]] Threshold around(const Image<std::uint8_t>& gray, int column, int row, int margin) const;
  void fill();

  int columns_ = 0, rows_ = 0, block_ = 32;
  std::vector<Block> blocks_;
  std::optional<Figure> figure_;
  Threshold mean_;
};

}  // namespace flexura
