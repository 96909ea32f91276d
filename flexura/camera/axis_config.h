#pragma once

#include <array>
#include <limits>

namespace flexura {

/// Motion limits of one motor-driven axis of a camera. The unit of positions is rad, m, or that of zoom
/// positions.
struct AxisConfig {
  std::array<double, 2> limits = {0, 0};  ///< Smallest and largest position.
  /// Largest speed, units of position per second.
  double max_rate = std::numeric_limits<double>::infinity();
  /// Largest acceleration, units of position per second squared.
  double max_acceleration = std::numeric_limits<double>::infinity();
  double resolution = 0;  ///< Smallest position increment that can be commanded; 0: continuous.
  double backlash = 0;    ///< Motor travel without motion of the axis after a reversal.
};

/// Returns the commandable position nearest to `position`. The result is within the limits. If the limits
/// contain a multiple of the resolution, the result is such a multiple.
[[nodiscard]] double commandable(const AxisConfig& axis, double position);

}  // namespace flexura
