#pragma once

#include <cstddef>

#include "flexura/model/arm.h"

namespace flexura {

/// `state` and a share of the way from one state to another, section by section; all three of one arm.
[[nodiscard]] inline ArmState plus_way(ArmState state, const ArmState& from, const ArmState& to,
                                       double share = 1) {
  for (std::size_t i = 0; i < state.bends.size(); ++i) {
    state.bends[i] += share * (to.bends[i] - from.bends[i]);
    state.stretches[i] += share * (to.stretches[i] - from.stretches[i]);
  }
  return state;
}

/// That share of the way from one state to another, section by section; both of one arm.
[[nodiscard]] inline ArmState between(const ArmState& from, const ArmState& to, double share) {
  return plus_way(from, from, to, share);
}

}  // namespace flexura
