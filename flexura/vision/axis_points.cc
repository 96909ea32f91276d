#include "flexura/vision/axis_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flexura {

AxisPoints independent_points(std::span<const AxisSample> axis) {
  constexpr std::size_t apart = 4;
  // Remaining error of smoothing and border model without noise (docs/studies/seeing.md), px.
  constexpr double least_sigma = 0.02;
  AxisPoints points;
  double squares = 0;
  for (std::size_t i = 0; i < axis.size(); i += apart) {
    if (!axis[i].is_seen) continue;
    points.pixels.push_back(axis[i].pixel);
    squares += axis[i].sigma * axis[i].sigma;
  }
  const double count = std::max(1.0, static_cast<double>(points.pixels.size()));
  points.sigma = std::max(least_sigma, std::sqrt(squares / count));
  return points;
}

}  // namespace flexura
