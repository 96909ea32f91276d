#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/kinematics/inverse.h"

namespace flexura {

/// Scale of a preference: minimises |(x - middle) / range|^2, element by element.
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
  /// Returns the bounds of the relative values.
  [[nodiscard]] Bounds relative(Bounds bounds) const;
};

/// Moves the solution x along its problem's solutions to a local minimum of the preference. Each step
/// linearises the problem, for which the minimum has a closed form, and goes there or part of the way. A
/// descent then returns to the problem. The step counts if the problem is met again and the preference is
/// smaller. x remains a solution.
void follow_objective(BoundedDescent& descent, const ObjectiveScale& scale, Eigen::VectorXd& x);

/// Brings a solution from follow_objective() to the minimum of the preference, by Newton steps on the surface
/// of solutions. The result x is a solution and no worse. Without these steps, follow_objective() converges
/// linearly, because it uses the surface's tangents but not its curvature. It ends about 1e-5 away, each time
/// elsewhere.
void run_down_to_minimum(BoundedDescent& descent, const ObjectiveScale& scale, Eigen::VectorXd& x);

}  // namespace flexura
