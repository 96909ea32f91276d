#pragma once

#include <Eigen/Core>
#include <numbers>

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

/// Moves the solution x of `problem` along its solutions to where the wish is smallest nearby. Each step
/// takes the problem as linear, for which the wish has its minimum in closed form, goes there or part of the
/// way, and comes back to the problem by a descent; it counts when the problem is met again and the wish is
/// smaller. x stays a solution.
template <class Problem>
void follow_wish(Problem& problem, const Bounds& bounds, const WishScale& scale, Eigen::VectorXd& x,
                 DescentMemory<Problem>& memory) {
  constexpr DescentLimits back{.iterations = 12, .slope = 1e-6};
  constexpr double least_gain = 1e-10;
  const Bounds relative_bounds = scale.relative(bounds);
  const Eigen::VectorXd ideal = Eigen::VectorXd::Zero(x.size());
  double wish = scale.relative(x).squaredNorm();
  Eigen::VectorXd candidate(x.size());
  for (int i = 0; i < 100; ++i) {
    problem.linearise(x, memory.r, memory.J);
    // In relative values: from the ideal, 0, the shortest step onto the linear problem's solutions.
    memory.J *= scale.range.asDiagonal();
    memory.r -= memory.J * scale.relative(x);
    bounded_step(relative_bounds, ideal, 1e-12, memory);
    const Eigen::VectorXd direction = scale.absolute(memory.trial) - x;
    double gained = 0.0;
    for (double part = 1.0; part > 1e-2 && gained == 0.0; part *= 0.5) {
      candidate = x + part * direction;
      project(bounds, candidate);
      if (descend(problem, bounds, back, candidate, memory) != Descent::met) continue;
      const double new_wish = scale.relative(candidate).squaredNorm();
      if (!(new_wish < wish)) continue;
      gained = wish - new_wish;
      wish = new_wish;
      x = candidate;
    }
    if (gained <= least_gain * wish) return;
  }
}

}  // namespace flexura
