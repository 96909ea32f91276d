#pragma once

#include <span>
#include <vector>

#include "flexura/math/median.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Returns the length of a centerline, px.
[[nodiscard]] inline double length_of(std::span<const AxisSample> axis) {
  double length = 0;
  for (std::size_t i = 1; i < axis.size(); ++i) length += (axis[i].pixel - axis[i - 1].pixel).norm();
  return length;
}

/// Returns the median width of a centerline, px, which must not be empty. `widths`: a buffer.
[[nodiscard]] inline double median_width(const std::vector<AxisSample>& axis, std::vector<double>& widths) {
  widths.clear();
  for (const AxisSample& sample : axis) widths.push_back(sample.width);
  return median(std::span(widths));
}

}  // namespace flexura
