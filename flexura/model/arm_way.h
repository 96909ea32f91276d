#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/model/arm.h"

namespace flexura {

/// The way from one state of an arm to another: by how much each section's bend (rad) and stretch change.
struct ArmWay {
  std::vector<Eigen::Vector2d> bends;
  std::vector<double> stretches;
};

/// The way that leads to `to` from `from`; both of one arm.
[[nodiscard]] inline ArmWay minus(const ArmState& to, const ArmState& from) {
  ArmWay way{to.bends, to.stretches};
  for (std::size_t i = 0; i < way.bends.size(); ++i) {
    way.bends[i] -= from.bends[i];
    way.stretches[i] -= from.stretches[i];
  }
  return way;
}

/// `state` and a share of a way; both of one arm.
[[nodiscard]] inline ArmState plus(ArmState state, const ArmWay& way, double share = 1) {
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    state.bends[i] += share * way.bends[i];
    state.stretches[i] += share * way.stretches[i];
  }
  return state;
}

/// The state `fraction` in [0, 1] of the way from one to another, bends and stretches changing linearly: the
/// paper's "linear interpolation algorithm" (section 4). Not plus(from, minus(to, from), fraction) to the
/// last bit, for it is exactly `from` at 0 and `to` at 1. Into `between`, which may be neither of the two.
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
