#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/blurred_step.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"

namespace flexura {

/// EdgeFinder's `widest_blur` for a single border, which the tails of its blur shift; for the two borders of
/// an arm the shifts cancel.
inline constexpr double lone_border_blur = 1.2;

/// A point of a figure's outer border.
struct BorderPoint {
  Eigen::Vector2d pixel = {0, 0};   ///< Subpixel position.
  Eigen::Vector2d normal = {1, 0};  ///< Outward, a unit vector.
  double contrast = 0;              ///< Contrast across the border, of 0 to 255.
  double residual = 0;              ///< Standard deviation of the local brightness from a blurred step.
};

/// Finds the outer border of a component with subpixel accuracy, in order around it. Searches from each pixel
/// that touches the outer background, along the picture's gradient there. Skips borders of holes, and parts
/// cut by the picture's border. `blur`: standard deviation of the border's blur, px.
void find_border(const Image<std::uint8_t>& gray, const Threshold& threshold, const Components& components,
                 std::uint32_t component, double blur, std::vector<BorderPoint>& border);

/// The largest figure of a picture, at least 24 px, and its border. Figures that touch the picture's border
/// count only if all do.
struct FigureBorder {
  Threshold threshold;
  std::string reason;               ///< Why no figure was found; "" if one was.
  std::int64_t area = 0;            ///< Number of pixels of the figure.
  double blur = 0;                  ///< Blur of its border, px.
  bool touches_border = false;      ///< Whether any of its pixels lies in the picture's outermost ring.
  std::vector<BorderPoint> points;  ///< Border points in order around it (find_border).
};
/// Finds the largest figure of a gray picture.
[[nodiscard]] FigureBorder largest_figure(const Image<std::uint8_t>& gray,
                                          const ThresholdConfig& config = {});

}  // namespace flexura
