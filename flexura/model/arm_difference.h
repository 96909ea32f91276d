#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/model/arm.h"

namespace flexura {

/// Difference between two states of an arm: the change of each section's bend (rad) and stretch.
struct ArmDifference {
  std::vector<Eigen::Vector2d> bends;
  std::vector<double> stretches;
};

/// Returns the difference `to` minus `from` of two states of the same arm.
[[nodiscard]] inline ArmDifference minus(const ArmState& to, const ArmState& from) {
  ArmDifference way{to.bends, to.stretches};
  for (std::size_t i = 0; i < way.bends.size(); ++i) {
    way.bends[i] -= from.bends[i];
    way.stretches[i] -= from.stretches[i];
  }
  return way;
}

/// Returns the sum of the squared bends of a difference, rad^2.
[[nodiscard]] inline double squared_bends(const ArmDifference& way) {
  double sum = 0;
  for (const Eigen::Vector2d& bend : way.bends) sum += bend.squaredNorm();
  return sum;
}

/// Returns `state` plus `share` times the difference `way`.
[[nodiscard]] inline ArmState plus(ArmState state, const ArmDifference& way, double share = 1) {
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    state.bends[i] += share * way.bends[i];
    state.stretches[i] += share * way.stretches[i];
  }
  return state;
}

/// Interpolates bends and stretches linearly between two states: the paper's "linear interpolation algorithm"
/// (section 4). At the fractions 0 and 1, the result is exactly `from` or `to`; plus(from, minus(to, from),
/// fraction) would have rounding errors. `between` must be a different object than `from` and `to`.
inline void interpolate(const ArmState& from, const ArmState& to, double fraction, ArmState& between) {
  between = fraction >= 1 ? to : from;
  if (fraction <= 0 || fraction >= 1) return;
  for (std::size_t i = 0; i < between.bends.size(); ++i) {
    between.bends[i] = (1 - fraction) * from.bends[i] + fraction * to.bends[i];
    between.stretches[i] = (1 - fraction) * from.stretches[i] + fraction * to.stretches[i];
  }
}
[[nodiscard]] inline ArmState interpolate(const ArmState& from, const ArmState& to, double fraction) {
  ArmState between;
  interpolate(from, to, fraction, between);
  return between;
}

}  // namespace flexura
