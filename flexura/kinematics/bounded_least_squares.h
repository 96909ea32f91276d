#pragma once

#include <Eigen/Core>
#include <cstddef>
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

/// The memory of a descent, for one problem's size.
struct DescentMemory {
  DescentMemory(const BoundedProblem& problem, Eigen::Index variables, std::size_t bound_count);

  Eigen::VectorXd r, trial_r;
  Eigen::MatrixXd J, trial_J, held_J;
  Eigen::VectorXd step, offset, trial, gradient;
  std::vector<char> is_held;
  double square = 0;   ///< |r|^2
  int iterations = 0;  ///< Linearisations so far, over all descents.

  /// r, J and `square` become those of x.
  void linearise(BoundedProblem& problem, const Eigen::VectorXd& x);
  /// gradient = J^T r
  void find_gradient();
};

/// memory.trial = x plus the step of least |J step + r|^2 + damping |step|^2 that keeps to the bounds: what
/// the bounds stop is stopped, and the other variables make up for it, until nothing more is stopped.
void bounded_step(const Bounds& bounds, const Eigen::VectorXd& x, double damping, DescentMemory& memory);

/// What ends a descent before the problem is met.
struct DescentLimits {
  int iterations = 60;
  double slope = 1e-4;  ///< Stationary when |free gradient| <= slope |r|.
};

/// Descends from x, which is within `bounds` and stays there, by damped Gauss-Newton steps. memory.r and .J
/// are those of x afterwards.
Descent descend(BoundedProblem& problem, const Bounds& bounds, const DescentLimits& limits,
                Eigen::VectorXd& x, DescentMemory& memory);

/// The same by spectral projected gradients (Birgin, Martinez, Raydan 2000: Barzilai-Borwein steps,
/// projected, with a search that forgives the last few rises). For minima with a large residual, the nearest
/// pose to a target out of reach: there Gauss-Newton's model of the curvature is wrong by the residual
/// itself.
Descent descend_gradient(BoundedProblem& problem, const Bounds& bounds, const DescentLimits& limits,
                         Eigen::VectorXd& x, DescentMemory& memory);

}  // namespace flexura
