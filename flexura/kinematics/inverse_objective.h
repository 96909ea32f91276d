#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/kinematics/inverse.h"

namespace flexura {

/// Scaling of variables for an objective, which is the sum over all variables of ((x - middle) / range)^2.
struct ObjectiveScale {
  ObjectiveScale(const ArmVariables& variables, InverseObjective objective);

  Eigen::VectorXd middle;
  Eigen::VectorXd range;

  [[nodiscard]] Eigen::VectorXd relative(const Eigen::VectorXd& x) const {
    return (x - middle).cwiseQuotient(range);
  }
  [[nodiscard]] Eigen::VectorXd absolute(const Eigen::VectorXd& y) const {
    return middle + y.cwiseProduct(range);
  }
  /// Returns the bounds of the scaled variables.
  [[nodiscard]] Bounds relative(Bounds bounds) const;
};

/// Moves the solution x along the set of solutions to a local minimum of the objective. Each step linearises
/// the problem, computes the minimum in closed form, and moves x to the minimum or a part of the way. A
/// descent then moves x back to a solution. A step is accepted if the descent finds a solution and the
/// objective has decreased. The resulting x is always a solution.
void follow_objective(BoundedDescent& descent, const ObjectiveScale& scale, Eigen::VectorXd& x);

/// Refines the result of follow_objective() by Newton steps on the surface of solutions. The resulting x is a
/// solution, and its objective is not larger than before. The refinement is needed because follow_objective()
/// uses the tangents of the surface but not its curvature. Therefore follow_objective() converges only
/// linearly, and its results scatter by about 1e-5 around the minimum.
void run_down_to_minimum(BoundedDescent& descent, const ObjectiveScale& scale, Eigen::VectorXd& x);

}  // namespace flexura
