#pragma once

#include <Eigen/Core>
#include <limits>

#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/inverse_starts.h"

namespace flexura {

/// Largest number of iterations for moving a state to its local minimum.
inline constexpr int settling_iterations = 6000;

/// Best result of a search up to now.
struct Found {
  Eigen::VectorXd x;
  double square = std::numeric_limits<double>::infinity();  ///< |r|^2 at x.
  Descent ended = Descent::exhausted;
  int starts = 0;

  [[nodiscard]] bool is_met() const { return ended == Descent::met; }
  void keep_better(const Eigen::VectorXd& other, double other_square, Descent other_ended) {
    if (other_ended != Descent::met && !(other_square < square)) return;
    x = other;
    square = other_square;
    ended = other_ended;
  }
};

/// Descends from one start after another until a solution is found. Stops after `max_starts` starts,
/// including the starts already counted in `found`.
void search(BoundedDescent& descent, InverseStarts& starts, int max_starts, Found& found);

/// Moves a result that is not a solution to its local minimum, with at most `iterations` iterations. Gradient
/// and Gauss-Newton steps alternate. Gradient steps are slow in long, narrow valleys of the error.
/// Gauss-Newton steps are slow if the residual at the minimum is large.
void settle(BoundedDescent& descent, int iterations, Found& found);

/// Returns the nearest state for a target known to be out of reach: the best minimum found from a few starts.
Found nearest(BoundedDescent& descent, InverseStarts& starts, int max_starts);

/// Returns why a result does not reach its target: the descent did not finish, active limits prevent a
/// solution, or the target is out of reach.
InverseOutcome outcome_of_missed(BoundedDescent& descent, const Found& found);

}  // namespace flexura
