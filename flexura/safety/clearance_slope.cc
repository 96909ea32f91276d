#include "flexura/safety/clearance_slope.h"

#include <array>
#include <cstddef>

namespace flexura {

std::optional<ClearanceSlope> clearance_slope(const ContactWatch& watch, const Arm& arm,
                                              const ArmState& state, double reach) {
  constexpr double small = 1e-3;
  ClearanceSlope slope{
      .clearance = watch.contact(state, reach).clearance,
      .by_state = Eigen::RowVectorXd::Zero(3 * static_cast<Eigen::Index>(state.bends.size()))};
  if (!(slope.clearance < reach)) return std::nullopt;
  const auto difference = [&](auto&& number) {
    std::array<double, 2> sides = {};
    for (std::size_t side = 0; side < 2; ++side) {
      ArmState moved = state;
      number(moved) += side == 0 ? small : -small;
      sides[side] = watch.contact(moved, 2 * reach).clearance;
    }
    return (sides[0] - sides[1]) / (2 * small);
  };
  for (std::size_t k = 0; k < state.bends.size(); ++k) {
    const auto column = 3 * static_cast<Eigen::Index>(k);
    slope.by_state[column] = difference([k](ArmState& moved) -> double& { return moved.bends[k].x(); });
    if (arm.kind == ArmKind::spatial)
      slope.by_state[column + 1] = difference([k](ArmState& moved) -> double& { return moved.bends[k].y(); });
    if (arm.sections[k].can_stretch())
      slope.by_state[column + 2] = difference([k](ArmState& moved) -> double& { return moved.stretches[k]; });
  }
  return slope;
}

}  // namespace flexura
