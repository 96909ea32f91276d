#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "flexura/kinematics/bounds.h"

// Levenberg-Marquardt method within bounds, for few residuals of possibly many variables.
//
// Bounds are enforced by projection and an active set, not by a smooth change of variables. Solutions at a
// limit are common: an arm reaches far corners with its sections fully bent. At a limit, a change of
// variables would have a zero derivative, converge very slowly, and not identify the active limit.
namespace flexura {

/// A least-squares problem: residuals r as functions of variables x. For 3, 5 or 6 residuals, the solver
/// allocates no memory.
class BoundedProblem {
 public:
  virtual ~BoundedProblem() = default;
  [[nodiscard]] virtual Eigen::Index row_count() const = 0;
  /// Computes the residuals r at x and their Jacobian J. The caller has set the sizes of r and J.
  virtual void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) = 0;
  /// Returns whether the residuals r are small enough for a solution.
  [[nodiscard]] virtual bool is_met(const Eigen::VectorXd& r) const = 0;
};

/// Reason for the end of a descent.
enum class Descent {
  met,         ///< The residuals are small enough (BoundedProblem::is_met).
  stationary,  ///< The point is a minimum within the bounds: no allowed direction decreases |r|.
  exhausted,   ///< The limit on iterations was reached.
};

/// Criteria that end a descent without a solution.
struct DescentLimits {
  int iterations = 60;  ///< Largest number of iterations.
  double slope = 1e-4;  ///< A point is stationary if |free gradient| <= slope |r|.
  /// If > 0: a point counts as stationary after this number of successive steps that each reduce |r|^2 by
  /// less than 1 %. Such steps occur if the residuals are discontinuous nearby, or if the minimum is in a
  /// long, narrow valley of |r|^2.
  int most_slow = 0;
};

/// Minimises the residuals of one problem by descents. Reuses memory between descents.
struct BoundedDescent {
  BoundedDescent(BoundedProblem& of, const Bounds& within, Eigen::Index variables);

  /// Descends from x by damped Gauss-Newton steps. x must be within `bounds` and remains within them.
  /// Afterwards, r and J are the residuals and the Jacobian at the resulting x.
  Descent descend(const DescentLimits& limits, Eigen::VectorXd& x);
  /// Descends by spectral projected gradients: projected Barzilai-Borwein steps with a nonmonotone line
  /// search (Birgin, Martinez, Raydan 2000). This method is meant for minima with a large residual, such as
  /// the nearest pose to an unreachable target. For these, the Gauss-Newton approximation of the curvature
  /// has an error proportional to the residual.
  Descent descend_gradient(const DescentLimits& limits, Eigen::VectorXd& x);

  /// Sets `trial` to x plus the step that minimizes |J step + r|^2 + damping |step|^2 within the bounds.
  /// Variables that would violate a bound are fixed at the bound, and the other variables are solved again.
  /// Fixing and solving are repeated until no bound is violated.
  void try_step(const Bounds& within, const Eigen::VectorXd& x, double damping);
  /// Computes `r`, `J`, `square` and `gradient` at x.
  void linearise(const Eigen::VectorXd& x);

  BoundedProblem& problem;
  const Bounds& bounds;
  Eigen::VectorXd r, trial_r;
  Eigen::MatrixXd J, trial_J, held_J;
  Eigen::VectorXd step, offset, trial, gradient;  ///< gradient = J^T r.
  std::vector<char> is_held;
  double square = 0;   ///< |r|^2.
  int iterations = 0;  ///< Number of linearizations in all descents so far.
  /// Limit on `iterations`, at which descents end as exhausted.
  int most_iterations = std::numeric_limits<int>::max();

 private:
  [[nodiscard]] int affordable(const DescentLimits& limits) const {
    return std::clamp(most_iterations - iterations, 0, limits.iterations);
  }
};

}  // namespace flexura
