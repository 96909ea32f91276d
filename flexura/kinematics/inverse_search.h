#pragma once

#include <Eigen/Core>
#include <limits>

#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/inverse_starts.h"

namespace flexura {

/// What a state may take to come to the bottom of its valley.
inline constexpr int settling_iterations = 6000;

/// The best that a search has found.
struct Found {
  Eigen::VectorXd x;
  double square = std::numeric_limits<double>::infinity();  ///< |r|^2 there.
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

/// Descends from one start after another until the problem is met or `max_starts` are made, those that
/// `found` has already counted in.
void search(BoundedDescent& descent, InverseStarts& starts, int max_starts, Found& found);

/// Brings what was not met to the bottom of its valley, within some `iterations`. Gradients and
/// Gauss-Newton's steps take turns: in a long valley the ones creep, in a valley whose bottom is far from the
/// target the others.
void settle(BoundedDescent& descent, int iterations, Found& found);

/// The nearest state to a problem known not to be met: the best of the valleys below a few starts.
Found nearest(BoundedDescent& descent, InverseStarts& starts, int max_starts);

/// Why what was found misses its target: the descent did not come to an end, or limits keep it from going on,
/// or nothing does and the target is out of reach.
InverseOutcome outcome_of_missed(BoundedDescent& descent, const Found& found);

}  // namespace flexura
