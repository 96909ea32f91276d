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

/// A straight, nearly vertical line in the picture: u = at + slope (v - middle_row).
struct UprightLine {
  double at = 0, slope = 0;  ///< u at the middle row, px; change of u per row, px.
  double rms = 0;            ///< Root mean square of the distances of points from the line, px.
  int count = 0;             ///< Number of rows in which the line was found.
};

/// Observation of the calibration cylinder (paper, section 3.4). The cylinder is dark and upright, and has
/// red lines parallel to its axis.
struct EtalonObservation {
  Threshold threshold;      ///< Threshold. If it separates no foreground, its `reason` states why.
  std::string reason;       ///< Reason why no cylinder was found; otherwise "".
  int top = 0, bottom = 0;  ///< First and last row of the silhouette.
  double middle_row = 0;    ///< Row half-way between top and bottom, the reference row of UprightLine.
  UprightLine left, right;  ///< Left and right side of the silhouette.
  /// Width of the silhouette at a tenth of its height below the upper end and above the lower end, px
  /// (docs/vision.md).
  double width_above = 0, width_below = 0;
  /// v of the silhouette's upper and lower end, measured near the silhouette's middle, px.
  std::optional<double> upper_edge, lower_edge;
  std::vector<UprightLine> lines;  ///< The red lines, from left to right.
  bool touches_border = false;     ///< Whether a pixel of the silhouette is in the picture's outermost ring.

  /// Returns u of the silhouette's middle at row v, px.
  [[nodiscard]] double middle(double v) const {
    return 0.5 * (left.at + right.at + (left.slope + right.slope) * (v - middle_row));
  }
};

/// Finds the calibration cylinder in a gray or colour picture. `gray`: the picture in gray (gray_picture()).
/// In a gray picture, the lines are found by their brightness.
[[nodiscard]] EtalonObservation find_etalon(const Image<std::uint8_t>& picture,
                                            const Image<std::uint8_t>& gray,
                                            const ThresholdConfig& config = {});

}  // namespace flexura
