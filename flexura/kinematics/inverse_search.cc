#include "flexura/kinematics/inverse_search.h"

#include <algorithm>
#include <cmath>

namespace flexura {
namespace {

// Returns true if x is a minimum up to its last digits: along the free gradient, |r| changes by at most a
// millionth of itself per radian.
bool is_level(BoundedDescent& descent, const Eigen::VectorXd& x) {
  constexpr double least_slope = 1e-6;
  descent.linearise(x);
  Eigen::VectorXd lower = x - descent.gradient;
  project(descent.bounds, lower);
  return (lower - x).norm() <= least_slope * std::sqrt(descent.square);
}

}  // namespace

void search(BoundedDescent& descent, InverseStarts& starts, int max_starts, Found& found) {
  // Short descents solve all targets except for tightly rolled arms, which need long descents.
  constexpr int patient_from = 30;
  constexpr DescentLimits brief{.iterations = 60};
  constexpr DescentLimits patient{.iterations = 250};
  Eigen::VectorXd x(descent.step.size());
  while (!found.is_met() && found.starts < max_starts) {
    starts.next(x);
    const Descent ended = descent.descend(found.starts < patient_from ? brief : patient, x);
    found.keep_better(x, descent.square, ended);
    ++found.starts;
  }
}

void settle(BoundedDescent& descent, int iterations, Found& found) {
  constexpr double slope = 1e-9;
  constexpr int most_turns = 10;
  const DescentLimits by_gradient{.iterations = std::max(iterations / most_turns, 10), .slope = slope};
  const DescentLimits by_newton{.iterations = std::max(iterations / (2 * most_turns), 5), .slope = slope};
  for (int turn = 0; turn < most_turns; ++turn) {
    Eigen::VectorXd x = found.x;
    const Descent ended = descent.descend_gradient(by_gradient, x);
    found.keep_better(x, descent.square, ended);
    // No improvement at a minimum: x was the minimum already.
    if (found.ended != Descent::met) found.ended = ended;
    if (ended != Descent::exhausted) return;
    x = found.x;
    const Descent newton = descent.descend(by_newton, x);
    found.keep_better(x, descent.square, newton);
    if (newton == Descent::met) return;
  }
  if (is_level(descent, found.x)) found.ended = Descent::stationary;
}

Found nearest(BoundedDescent& descent, InverseStarts& starts, int max_starts) {
  constexpr DescentLimits rough{.iterations = 20, .slope = 1e-3};
  constexpr DescentLimits finer{.iterations = 60, .slope = 1e-6};
  Found found;
  Eigen::VectorXd x(descent.step.size());
  while (found.starts < max_starts) {
    starts.next(x);
    descent.descend(rough, x);
    const Descent ended = descent.descend_gradient(finer, x);
    found.keep_better(x, descent.square, ended);
    ++found.starts;
  }
  settle(descent, settling_iterations, found);
  return found;
}

InverseOutcome outcome_of_missed(BoundedDescent& descent, const Found& found) {
  if (found.ended == Descent::exhausted) return InverseOutcome::no_convergence;
  constexpr double least_pressure = 1e-6;  // Share of the residual's norm.
  descent.linearise(found.x);
  return pressure(descent.bounds, found.x, descent.gradient) > least_pressure * std::sqrt(descent.square)
             ? InverseOutcome::at_limit
             : InverseOutcome::not_reachable;
}

}  // namespace flexura
