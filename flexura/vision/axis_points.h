#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Visible points of a centerline, so far apart that their errors are nearly independent.
struct AxisPoints {
  std::vector<Eigen::Vector2d> pixels;  ///< Points, px.
  double sigma = 0;  ///< Root mean square of the points' standard deviations across the centerline, px.
};
[[nodiscard]] AxisPoints independent_points(std::span<const AxisSample> axis);

}  // namespace flexura
