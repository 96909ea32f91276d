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

/// EdgeFinder's `widest_blur` for one border alone, which shifts with the tails of its blur; of an arm's two
/// the shifts cancel.
inline constexpr double lone_border_blur = 1.2;

/// A point of a figure's outer border.
struct BorderPoint {
  Eigen::Vector2d pixel = {0, 0};   ///< To a small part of a pixel.
  Eigen::Vector2d normal = {1, 0};  ///< Outward, a unit vector.
  double contrast = 0;              ///< Across the border, of 0 to 255.
  double residual = 0;              ///< Standard deviation of the brightnesses there from a blurred step.
};

/// The outer border of a component, to a small part of a pixel: from each of its pixels that the ground
/// outside touches, along the picture's gradient there, in their order around it. Borders of holes, and what
/// the picture's own border cuts, are left out. `blur`: standard deviation of the border's blur, px.
void find_border(const Image<std::uint8_t>& gray, const Threshold& threshold, const Components& components,
                 std::uint32_t component, double blur, std::vector<BorderPoint>& border);

/// The largest figure of a picture, of 24 px at least, and its border: of the figures that do not touch the
/// picture's own border, or of all where none such is.
struct FigureBorder {
  Threshold threshold;
  std::string reason;               ///< Why there is none; "" when there is one.
  std::int64_t area = 0;            ///< Pixels of the figure.
  double blur = 0;                  ///< Of its border, px.
  bool touches_border = false;      ///< Any of its pixels lies in the picture's outermost ring.
  std::vector<BorderPoint> points;  ///< In their order around it (find_border).
};
/// Of a gray picture.
[[nodiscard]] FigureBorder largest_figure(const Image<std::uint8_t>& gray,
                                          const ThresholdConfig& config = {});

}  // namespace flexura
