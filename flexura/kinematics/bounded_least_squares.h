#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "flexura/kinematics/bounds.h"

// Levenberg-Marquardt within bounds, for few residuals of possibly many variables.
//
// Bounds are held by projection and an active set, not by a smooth change of variables: solutions at a limit
// are common (a tentacle reaches far corners with its sections fully bent), and there a change of variables
// has a derivative of zero, crawls, and cannot tell which limit holds it.
namespace flexura {

/// Residuals r of variables x. Where they are 3, 5 or 6, what is done with them allocates nothing.
class BoundedProblem {
 public:
  virtual ~BoundedProblem() = default;
  [[nodiscard]] virtual Eigen::Index row_count() const = 0;
  /// r at x, and its derivatives; both of their size already.
  virtual void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) = 0;
  /// Whether nothing more is asked for.
  [[nodiscard]] virtual bool is_met(const Eigen::VectorXd& r) const = 0;
};

/// How a descent ended.
enum class Descent {
  met,         ///< The problem is met.
  stationary,  ///< No free direction leads down from here: a minimum within the bounds.
  exhausted,   ///< Out of iterations.
};

/// What ends a descent before the problem is met.
struct DescentLimits {
  int iterations = 60;
  double slope = 1e-4;  ///< Stationary when |free gradient| <= slope |r|.
};

/// Descents of one problem of so many variables, and their memory.
struct BoundedDescent {
  BoundedDescent(BoundedProblem& of, const Bounds& within, Eigen::Index variables);

  /// Descends from x, which is within `bounds` and stays there, by damped Gauss-Newton steps. r and J are
  /// those of x afterwards.
  Descent descend(const DescentLimits& limits, Eigen::VectorXd& x);
  /// The same by spectral projected gradients (Birgin, Martinez, Raydan 2000: Barzilai-Borwein steps,
  /// projected, with a search that forgives the last few rises). For minima with a large residual, the
  /// nearest pose to a target out of reach: there Gauss-Newton's model of the curvature is wrong by the
  /// residual itself.
  Descent descend_gradient(const DescentLimits& limits, Eigen::VectorXd& x);

  /// `trial` becomes x plus the step of least |J step + r|^2 + damping |step|^2 that keeps to bounds: what
  /// they stop is stopped, and the other variables make up for it, until nothing more is stopped.
  void try_step(const Bounds& within, const Eigen::VectorXd& x, double damping);
  /// r, J, `square` and `gradient` become those of x.
  void linearise(const Eigen::VectorXd& x);

  BoundedProblem& problem;
  const Bounds& bounds;
  Eigen::VectorXd r, trial_r;
  Eigen::MatrixXd J, trial_J, held_J;
  Eigen::VectorXd step, offset, trial, gradient;  ///< gradient = J^T r
  std::vector<char> is_held;
  double square = 0;   ///< |r|^2
  int iterations = 0;  ///< Linearisations so far, over all descents.
  /// Descents end as exhausted when there are so many.
  int most_iterations = std::numeric_limits<int>::max();

 private:
  [[nodiscard]] int affordable(const DescentLimits& limits) const {
    return std::clamp(most_iterations - iterations, 0, limits.iterations);
  }
};

}  // namespace flexura
