#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Points of a median axis that are seen, so far apart that their errors have little in common.
struct AxisPoints {
  std::vector<Eigen::Vector2d> pixels;
  double sigma = 0;  ///< What they are known to across the axis, root mean square, px.
};
[[nodiscard]] AxisPoints independent_points(std::span<const AxisSample> axis);

}  // namespace flexura
