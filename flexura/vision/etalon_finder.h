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
  double at = 0, slope = 0;  ///< px, at the middle row; px per row.
  double rms = 0;            ///< px
  int count = 0;             ///< Number of rows in which it was found.
};

/// Observation of the calibration cylinder (section 3.4): dark, upright, with red lines along it.
struct EtalonObservation {
  Threshold threshold;      ///< Includes the reason if it separates nothing.
  std::string reason;       ///< Why no cylinder was found; "" if one was.
  int top = 0, bottom = 0;  ///< First and last row of the silhouette.
  double middle_row = 0;    ///< Half-way between top and bottom: reference row of the lines' `at`.
  UprightLine left, right;  ///< The silhouette's sides.
  /// Width of the silhouette a tenth of its height inside each end, px (docs/vision.md).
  double width_above = 0, width_below = 0;
  std::optional<double> upper_edge, lower_edge;  ///< v of the silhouette's ends, near its middle, px.
  std::vector<UprightLine> lines;                ///< The red lines, left to right.
  bool touches_border = false;  ///< Whether the silhouette reaches into the picture's outermost ring.

  /// Returns its middle, u, at row v, px.
  [[nodiscard]] double middle(double v) const {
    return 0.5 * (left.at + right.at + (left.slope + right.slope) * (v - middle_row));
  }
};

/// Finds the cylinder in a picture, gray or red, green, blue; `gray` is the same picture in gray
/// (gray_picture()). In a gray picture the lines are found by their brightness.
[[nodiscard]] EtalonObservation find_etalon(const Image<std::uint8_t>& picture,
                                            const Image<std::uint8_t>& gray,
                                            const ThresholdConfig& config = {});

}  // namespace flexura
