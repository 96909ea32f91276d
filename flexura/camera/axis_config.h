#pragma once

#include <array>
#include <limits>

namespace flexura {

/// Motion limits of one motor-driven axis of a camera, in the units of its position: rad, m, or the zoom's.
struct AxisConfig {
  std::array<double, 2> limits = {0, 0};                              ///< Smallest and largest position.
  double max_rate = std::numeric_limits<double>::infinity();          ///< Per second.
  double max_acceleration = std::numeric_limits<double>::infinity();  ///< Per second squared.
  double resolution = 0;  ///< Distance of the positions that can be commanded; 0: any.
  double backlash = 0;    ///< Motion of the motor without effect on reversal.
};

/// Returns the position nearest to `position` that can be commanded. It is within the limits, and a whole
/// number of resolution steps from 0 if there is one within the limits.
[[nodiscard]] double commandable(const AxisConfig& axis, double position);

}  // namespace flexura
