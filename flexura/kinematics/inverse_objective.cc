#include "flexura/kinematics/inverse_objective.h"

#include <algorithm>
#include <numbers>

namespace flexura {

ObjectiveScale::ObjectiveScale(const ArmVariables& variables, InverseObjective objective)
    : middle(Eigen::VectorXd::Zero(variables.size())), range(Eigen::VectorXd::Ones(variables.size())) {
  const bool is_mid_range = objective == InverseObjective::mid_range;
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

Bounds ObjectiveScale::relative(Bounds bounds) const {
  for (Bound& bound : bounds) {
    // The two variables of a disk have the same range and the middle 0.
    bound.low = (bound.low - middle[bound.at]) / range[bound.at];
    bound.high = (bound.high - middle[bound.at]) / range[bound.at];
  }
  return bounds;
}

void follow_objective(BoundedDescent& descent, const ObjectiveScale& scale, Eigen::VectorXd& x) {
  constexpr DescentLimits back{.iterations = 12, .slope = 1e-6};
  constexpr double least_gain = 1e-10;
  const Bounds relative_bounds = scale.relative(descent.bounds);
  const Eigen::VectorXd ideal = Eigen::VectorXd::Zero(x.size());
  double objective = scale.relative(x).squaredNorm();
  Eigen::VectorXd candidate(x.size());
  for (int i = 0; i < 100; ++i) {
    descent.problem.linearise(x, descent.r, descent.J);
    // In relative values: the shortest step from the ideal, 0, to the linear problem's solutions.
    descent.J *= scale.range.asDiagonal();
    descent.r -= descent.J.lazyProduct(scale.relative(x));
    descent.try_step(relative_bounds, ideal, 1e-12);
    const Eigen::VectorXd direction = scale.absolute(descent.trial) - x;
    double gained = 0.0;
    for (double part = 1.0; part > 1e-2 && gained == 0.0; part *= 0.5) {
      candidate = x + part * direction;
      project(descent.bounds, candidate);
      if (descent.descend(back, candidate) != Descent::met) continue;
      const double new_objective = scale.relative(candidate).squaredNorm();
      if (!(new_objective < objective)) continue;
      gained = objective - new_objective;
      objective = new_objective;
      x = candidate;
    }
    if (gained <= least_gain * objective) return;
  }
}

}  // namespace flexura
