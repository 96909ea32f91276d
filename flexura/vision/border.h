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
  Eigen::Vector2d pixel = {0, 0};
  Eigen::Vector2d normal = {1, 0};  ///< Outward, a unit vector.
  double contrast = 0;
  double residual = 0;  ///< Standard deviation of the brightnesses there from a blurred step.
};

/// The outer border of a component, to a small part of a pixel: from each of its pixels that the ground
/// outside touches, along the picture's gradient there, in their order around it. Borders of holes, and what
/// the picture's own border cuts, are left out. `blur`: standard deviation of the border's blur, px.
void find_border(const Image<std::uint8_t>& gray, const Threshold& threshold, const Components& components,
                 std::uint32_t component, double blur, std::vector<BorderPoint>& border);

/// The largest figure of a picture and its border.
struct FigureBorder {
  Threshold threshold;
  std::string reason;  ///< Why there is none; "" when there is one.
  std::int64_t area = 0;
  double blur = 0;  ///< Of its border, px.
  bool touches_border = false;
  std::vector<BorderPoint> points;
};
[[nodiscard]] FigureBorder largest_figure(const Image<std::uint8_t>& gray,
                                          const ThresholdConfig& config = {});

}  // namespace flexura
