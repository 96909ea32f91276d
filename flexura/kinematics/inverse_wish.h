#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/kinematics/inverse.h"

namespace flexura {

/// A wish in numbers: |(x - middle) / range|^2, entry by entry, shall be small.
struct WishScale {
  WishScale(const ArmVariables& variables, InverseWish wish);

  Eigen::VectorXd middle;
  Eigen::VectorXd range;

  [[nodiscard]] Eigen::VectorXd relative(const Eigen::VectorXd& x) const {
    return (x - middle).cwiseQuotient(range);
  }
  [[nodiscard]] Eigen::VectorXd absolute(const Eigen::VectorXd& y) const {
    return middle + y.cwiseProduct(range);
  }
  /// Bounds of the relative values.
  [[nodiscard]] Bounds relative(Bounds bounds) const;
};

/// Moves the solution x along its problem's solutions to where the wish is smallest nearby. Each step takes
/// the problem as linear, for which the wish has its minimum in closed form, goes there or part of the way,
/// and comes back to the problem by a descent; it counts when the problem is met again and the wish is
/// smaller. x stays a solution.
void follow_wish(BoundedDescent& descent, const WishScale& scale, Eigen::VectorXd& x);

/// Brings a solution that follow_wish has led near a minimum of the wish to the minimum itself, by Newton's
/// steps on the surface of solutions: x is one afterwards too, and no worse. follow_wish knows that surface's
/// tangents but not how it bends, and comes nearer by a factor an iteration: it ends some 1e-5 away, each
/// time elsewhere.
void run_down_to_minimum(BoundedDescent& descent, const WishScale& scale, Eigen::VectorXd& x);

}  // namespace flexura
