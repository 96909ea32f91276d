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

/// How the brightness that separates figure from ground is chosen from the picture's histogram (section 3.4).
enum class ThresholdMethod {
  otsu,      ///< The largest variance between the two classes (N. Otsu, 1979).
  two_mode,  ///< The deepest valley between the histogram's two peaks.
  fixed,     ///< As given.
  by_block,  ///< Otsu's, of each block of the picture, and linear between blocks: for uneven screens.
};
const std::vector<std::string>& names_of(const ThresholdMethod*);

/// Which side of the threshold the figure is on.
enum class Figure { dark, bright };
const std::vector<std::string>& names_of(const Figure*);

/// How figure and ground are told apart.
struct ThresholdConfig {
  ThresholdMethod method = ThresholdMethod::otsu;
  double level = 127.5;          ///< With `fixed`, of 0 to 255.
  std::optional<Figure> figure;  ///< Decided by the picture's border when left out: what is there is ground.
  int block = 32;                ///< px, with `by_block`.
};

/// How often each brightness occurs; of pictures with more than 8 bits, by their upper 8 bits.
using Histogram = std::array<std::uint32_t, 256>;

/// Of all pixels, or of a share evenly over the picture when it has more than `samples` of them.
[[nodiscard]] Histogram histogram_of(const Image<std::uint8_t>& gray, std::size_t samples = 1U << 30U);

/// A threshold, and what the histogram says of it.
struct Threshold {
  ThresholdMethod method = ThresholdMethod::otsu;
  double level = 0;             ///< Between two brightnesses of 0 to 255.
  double dark = 0, bright = 0;  ///< Mean brightness of either class.
  double mean = 0;              ///< Of all.
  double spread = 0;            ///< Standard deviation within the classes.
  Figure figure = Figure::dark;
  /// Why there is no figure to be had ("the picture is blank ..."); "" when there is.
  std::string reason;
};

/// The threshold of a histogram by Otsu's method or between its two modes, or as fixed; with the reason why
/// it separates nothing, if that is so.
[[nodiscard]] Threshold threshold_of(const Histogram& histogram, const ThresholdConfig& config = {});

/// The same of a picture, with the side on which the figure is. `samples`: of the histogram.
[[nodiscard]] Threshold threshold_of(const Image<std::uint8_t>& gray, const ThresholdConfig& config,
                                     std::size_t samples = 1U << 30U);

/// Thresholds by block, of a grid of blocks' middles.
class BlockThresholds {
 public:
  /// Looks at each block with as much around it as it takes until two classes stand apart. Blocks in which
  /// none do take what is between the others. False, and no thresholds, when no block has any.
  bool make(const Image<std::uint8_t>& gray, const ThresholdConfig& config);
  /// The mean of the blocks in which two classes stand apart; its figure is the one that is not at the
  /// picture's border.
  [[nodiscard]] Threshold mean(const Image<std::uint8_t>& gray) const;
  /// The level at each pixel of row v, rounded up.
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
