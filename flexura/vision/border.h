#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/blurred_step.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"

namespace flexura {

/// Parameter `widest_blur` of EdgeFinder for single borders, in samples. The neglected tails of the blur
/// shift a border. For the two borders of an arm, these shifts cancel.
inline constexpr double lone_border_blur = 1.2;

/// A point of a figure's outer border.
struct BorderPoint {
  Eigen::Vector2d pixel = {0, 0};   ///< Subpixel position, px.
  Eigen::Vector2d normal = {1, 0};  ///< Outward unit normal.
  double contrast = 0;              ///< Contrast across the border, on a scale from 0 to 255.
  /// Standard deviation of the difference between the local brightness and a blurred step, on a scale from 0
  /// to 255.
  double residual = 0;
};

/// Finds the outer border of a component with subpixel accuracy. The points are in order around the
/// component. At each pixel that touches the outer background, it searches the border along the picture's
/// gradient. Borders of holes, parts that the picture's border cuts, and pixels for which `is_known` returns
/// true are omitted. `blur` is the standard deviation of the border's blur, px.
void find_border(const Image<std::uint8_t>& gray, const Threshold& threshold, const Components& components,
                 std::uint32_t component, double blur, std::vector<BorderPoint>& border,
                 const std::function<bool(const Eigen::Vector2d&)>& is_known = {});

/// The largest figure of a picture, with at least 24 pixels, and its border. Figures that touch the picture's
/// border are considered only if all figures touch the border.
struct FigureBorder {
  Threshold threshold;
  std::string reason;               ///< Reason why no figure was found; otherwise "".
  std::int64_t area = 0;            ///< Number of pixels of the figure.
  double blur = 0;                  ///< Standard deviation of the blur of the figure's border, px.
  bool touches_border = false;      ///< Whether any pixel of the figure is in the picture's outermost ring.
  std::vector<BorderPoint> points;  ///< Border points in order around the figure (find_border).
};
/// Finds the largest figure of a gray picture and its border.
[[nodiscard]] FigureBorder largest_figure(const Image<std::uint8_t>& gray,
                                          const ThresholdConfig& config = {});

}  // namespace flexura
