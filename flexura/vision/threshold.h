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

/// How the brightness that separates foreground and background is chosen from the picture's histogram
/// (section 3.4).
enum class ThresholdMethod {
  otsu,      ///< The largest variance between the two classes (N. Otsu, 1979).
  two_mode,  ///< The deepest valley between the histogram's two peaks.
  fixed,     ///< `ThresholdConfig::level`.
  by_block,  ///< Otsu's for each block of the picture, linear between blocks: for uneven screens.
};
const std::vector<std::string>& names_of(const ThresholdMethod*);

/// Side of the threshold on which the foreground is.
enum class Figure { dark, bright };
const std::vector<std::string>& names_of(const Figure*);

/// Separation of foreground and background.
struct ThresholdConfig {
  ThresholdMethod method = ThresholdMethod::otsu;
  double level = 127.5;          ///< With `fixed`, of 0 to 255.
  std::optional<Figure> figure;  ///< Default: the class at the picture's border is background.
  int block = 32;                ///< px, with `by_block`.
};

/// Frequency of each brightness; for pictures with more than 8 bits, of their upper 8 bits.
using Histogram = std::array<std::uint32_t, 256>;

/// Computes the histogram of all pixels, or of an evenly spread share if there are more than `samples`.
[[nodiscard]] Histogram histogram_of(const Image<std::uint8_t>& gray, std::size_t samples = 1U << 30U);

/// A threshold and the statistics of its classes.
struct Threshold {
  ThresholdMethod method = ThresholdMethod::otsu;
  double level = 0;             ///< Between two brightnesses of 0 to 255.
  double dark = 0, bright = 0;  ///< Mean brightness of each class.
  double mean = 0;              ///< Mean of all.
  double spread = 0;            ///< Standard deviation within the classes.
  Figure figure = Figure::dark;
  /// Why no foreground can be separated ("the picture is blank ..."); "" if it can.
  std::string reason;
};

/// Returns the threshold of a histogram by Otsu's method, between its two modes, or as fixed; with a reason
/// if it separates nothing.
[[nodiscard]] Threshold threshold_of(const Histogram& histogram, const ThresholdConfig& config = {});

/// Returns the threshold of a picture, with the side of the foreground. `samples`: of the histogram.
[[nodiscard]] Threshold threshold_of(const Image<std::uint8_t>& gray, const ThresholdConfig& config,
                                     std::size_t samples = 1U << 30U);

/// Thresholds of blocks, on the grid of their middles.
class BlockThresholds {
 public:
  /// Evaluates each block in a neighbourhood that grows until two classes separate; blocks where none do are
  /// interpolated. Returns false, without thresholds, if no block has any.
  bool make(const Image<std::uint8_t>& gray, const ThresholdConfig& config);
  /// Returns the mean of the blocks in which two classes separate; its figure is the class that is not at the
  /// picture's border.
  [[nodiscard]] Threshold mean(const Image<std::uint8_t>& gray) const;
  /// Sets the level at each pixel of row v, rounded up.
  void row(int v, std::vector<std::uint8_t>& levels) const;

 private:
  struct Block {
    double level = std::numeric_limits<double>::quiet_NaN(), dark = 0, bright = 0;
    double mean = 0;  // Of its own pixels.

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
