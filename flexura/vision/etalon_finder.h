#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/threshold.h"

namespace flexura {

/// A straight line in the picture: u = at + slope (v - middle row of the figure).
struct UprightLine {
  double at = 0, slope = 0;  ///< px, at the middle row; px a row.
  double rms = 0;            ///< px
  int count = 0;             ///< Of rows in which it was seen.
};

/// What is seen of the calibration cylinder (section 3.4): dark, upright, with red lines along it.
struct EtalonSighting {
  Threshold threshold;      ///< With the reason where it separates nothing.
  std::string reason;       ///< Why there is none; "" when there is one.
  int top = 0, bottom = 0;  ///< First and last row of the silhouette.
  double middle_row = 0;    ///< Half-way between top and bottom: where the lines' `at` counts.
  UprightLine left, right;  ///< The silhouette's sides.
  double width_above = 0,
         width_below = 0;  ///< Of the silhouette a tenth of its height in, px (docs/vision.md).
  std::optional<double> upper_edge, lower_edge;  ///< v of the silhouette's ends, near its middle, px.
  std::vector<UprightLine> lines;                ///< The red ones, left to right.
  bool touches_border = false;  ///< The silhouette reaches into the picture's outermost ring.

  /// Its middle, u, at row v, px.
  [[nodiscard]] double middle(double v) const {
    return 0.5 * (left.at + right.at + (left.slope + right.slope) * (v - middle_row));
  }
};

/// Of a picture, gray or red, green, blue, and the same in gray (gray_picture()), which is of the same size.
/// In a gray one the lines show by their brightness.
[[nodiscard]] EtalonSighting find_etalon(const Image<std::uint8_t>& picture, const Image<std::uint8_t>& gray,
                                         const ThresholdConfig& config = {});

}  // namespace flexura
