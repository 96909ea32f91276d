#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "flexura/kinematics/bounds.h"

// Levenberg-Marquardt within bounds, for few residuals of possibly many variables.
//
// Bounds are kept by projection and an active set, not by a smooth change of variables. Solutions at a limit
// are common: a tentacle reaches far corners with its sections fully bent. There a change of variables has a
// zero derivative, converges very slowly, and cannot identify the active limit.
namespace flexura {

/// Residuals r of variables x. With 3, 5 or 6 residuals, solving allocates no memory.
class BoundedProblem {
 public:
  virtual ~BoundedProblem() = default;
  [[nodiscard]] virtual Eigen::Index row_count() const = 0;
  /// Computes r at x, and its derivatives; both already have their size.
  virtual void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) = 0;
  /// Returns true if r is small enough.
  [[nodiscard]] virtual bool is_met(const Eigen::VectorXd& r) const = 0;
};

/// Result of a descent.
enum class Descent {
  met,         ///< The problem is met.
  stationary,  ///< No free direction leads down: a minimum within the bounds.
  exhausted,   ///< No iterations left.
};

/// Limits of a descent that does not meet the problem.
struct DescentLimits {
  int iterations = 60;
  double slope = 1e-4;  ///< Stationary if |free gradient| <= slope |r|.
};

/// Solves one problem in this number of variables by descents, and keeps their memory.
struct BoundedDescent {
  BoundedDescent(BoundedProblem& of, const Bounds& within, Eigen::Index variables);

  /// Descends from x, which is within `bounds` and stays there, by damped Gauss-Newton steps. Afterwards r
  /// and J are those of x.
  Descent descend(const DescentLimits& limits, Eigen::VectorXd& x);
  /// Descends by spectral projected gradients: projected Barzilai-Borwein steps, with a search that tolerates
  /// the last few rises (Birgin, Martinez, Raydan 2000). For minima with a large residual, such as the
  /// nearest pose to an unreachable target. There the Gauss-Newton model of the curvature is wrong by the
  /// residual itself.
  Descent descend_gradient(const DescentLimits& limits, Eigen::VectorXd& x);

  /// Sets `trial` to x plus the step of least |J step + r|^2 + damping |step|^2 within the bounds. Variables
  /// that violate bounds are held, and the others compensate, until no more are violated.
  void try_step(const Bounds& within, const Eigen::VectorXd& x, double damping);
  /// Computes r, J, `square` and `gradient` at x.
  void linearise(const Eigen::VectorXd& x);

  BoundedProblem& problem;
  const Bounds& bounds;
  Eigen::VectorXd r, trial_r;
  Eigen::MatrixXd J, trial_J, held_J;
  Eigen::VectorXd step, offset, trial, gradient;  ///< gradient = J^T r.
  std::vector<char> is_held;
  double square = 0;   ///< |r|^2.
  int iterations = 0;  ///< Linearisations of all descents so far.
  /// Descents end as exhausted at this number.
  int most_iterations = std::numeric_limits<int>::max();

 private:
  [[nodiscard]] int affordable(const DescentLimits& limits) const {
    return std::clamp(most_iterations - iterations, 0, limits.iterations);
  }
};

}  // namespace flexura
