#pragma once

#include <Eigen/Core>
#include <limits>

#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/inverse_starts.h"

namespace flexura {

/// Most iterations to bring a state to its minimum.
inline constexpr int settling_iterations = 6000;

/// Best result of a search so far.
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

/// Descends from one start after another until the problem is met or `max_starts` starts are made, including
/// those already counted in `found`.
void search(BoundedDescent& descent, InverseStarts& starts, int max_starts, Found& found);

/// Brings an unmet result to its local minimum, within `iterations`. Gradient and Gauss-Newton steps
/// alternate: gradients are slow in a long valley, Gauss-Newton in one whose minimum is far from the target.
void settle(BoundedDescent& descent, int iterations, Found& found);

/// Returns the nearest state for a problem known to be unreachable: the best minimum from a few starts.
Found nearest(BoundedDescent& descent, InverseStarts& starts, int max_starts);

/// Returns the reason why the result misses its target: the descent did not finish, limits hold it, or the
/// target is out of reach.
InverseOutcome outcome_of_missed(BoundedDescent& descent, const Found& found);

}  // namespace flexura
