#pragma once

#include <array>
#include <limits>

namespace flexura {

/// How one motor-driven axis of a camera may move, in the units of its position: rad, m, or a zoom's.
struct AxisConfig {
  std::array<double, 2> limits = {0, 0};                              ///< Smallest and largest position.
  double max_rate = std::numeric_limits<double>::infinity();          ///< A second.
  double max_acceleration = std::numeric_limits<double>::infinity();  ///< A second squared.
  double resolution = 0;  ///< Distance of the positions that can be commanded; 0: any.
  double backlash = 0;    ///< Play: what the motor moves in vain when it turns back.
};

/// The position nearest to `position` that can be commanded: within the limits, and a whole number of steps
/// of the resolution from 0 where there is one within the limits.
[[nodiscard]] double commandable(const AxisConfig& axis, double position);

}  // namespace flexura
