#include "flexura/camera/axis_config.h"

#include <algorithm>
#include <cmath>

#include "flexura/camera/axis_fields.h"

namespace flexura {

double commandable(const AxisConfig& axis, double position) {
  const double inside = std::clamp(position, axis.limits[0], axis.limits[1]);
  if (!(axis.resolution > 0)) return inside;
  double step = std::round(inside / axis.resolution);
  if (step * axis.resolution > axis.limits[1]) --step;
  if (step * axis.resolution < axis.limits[0]) ++step;
  const double stepped = step * axis.resolution;
  return stepped <= axis.limits[1] ? stepped : inside;
}

void check_limits(const std::array<double, 2>& limits, Reader& reader) {
  if (limits[0] > limits[1]) reader.problem_at("limits", "expected the smaller position first");
}

}  // namespace flexura
