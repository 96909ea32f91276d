#include "flexura/kinematics/inverse_wish.h"

#include <algorithm>

namespace flexura {

WishScale::WishScale(const ArmVariables& variables, InverseWish wish)
    : middle(Eigen::VectorXd::Zero(variables.size())), range(Eigen::VectorXd::Ones(variables.size())) {
  const bool is_mid_range = wish == InverseWish::mid_range;
  for (const ArmVariables::Part& part : variables.parts()) {
    if (is_mid_range) {
      range.segment(part.at, part.is_spatial ? 2 : 1).setConstant(std::min(part.max_bend, std::numbers::pi));
    }
    if (!part.is_stretchable) continue;
    const auto [low, high] = part.stretch_limits;
    middle[part.stretch_at()] = is_mid_range ? 0.5 * (low + high) : 1.0;
    if (is_mid_range) range[part.stretch_at()] = 0.5 * (high - low);
  }
}

Bounds WishScale::relative(Bounds bounds) const {
  for (Bound& bound : bounds) {
    // A disk's two variables share their range and have their middle at 0.
    bound.low = (bound.low - middle[bound.at]) / range[bound.at];
    bound.high = (bound.high - middle[bound.at]) / range[bound.at];
  }
  return bounds;
}

}  // namespace flexura
