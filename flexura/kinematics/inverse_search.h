#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/inverse_starts.h"
#include "flexura/kinematics/projected_gradient.h"

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
template <class Problem>
void search(Problem& problem, const ArmVariables& variables, InverseStarts& starts, int max_starts,
            DescentMemory<Problem>& memory, Found& found) {
  // Short descents answer all but the tightly rolled arms, which need patience.
  constexpr int patient_from = 30;
  constexpr DescentLimits brief{.iterations = 60};
  constexpr DescentLimits patient{.iterations = 250};
  Eigen::VectorXd x(variables.size());
  while (!found.is_met() && found.starts < max_starts) {
    starts.next(x);
    const DescentLimits& limits = found.starts < patient_from ? brief : patient;
    const Descent ended = descend(problem, variables.bounds(), limits, x, memory);
    found.keep_better(x, memory.r.squaredNorm(), ended);
    ++found.starts;
  }
}

/// Whether x is the bottom of a valley but for its last digits: along the slope that the bounds leave, |r|
/// changes by no more than a millionth of itself a radian.
template <class Problem>
bool is_level(Problem& problem, const ArmVariables& variables, const Eigen::VectorXd& x,
              DescentMemory<Problem>& memory) {
  constexpr double least_slope = 1e-6;
  problem.linearise(x, memory.r, memory.J);
  ++memory.iterations;
  Eigen::VectorXd lower = x - memory.J.transpose() * memory.r;
  project(variables.bounds(), lower);
  return (lower - x).norm() <= least_slope * memory.r.norm();
}

/// Brings what was not met to the bottom of its valley, within some `iterations`. Gradients and
/// Gauss-Newton's steps take turns: in a long valley the ones creep, in a valley whose bottom is far from the
/// target the others.
template <class Problem>
void settle(Problem& problem, const ArmVariables& variables, int iterations, Found& found,
            DescentMemory<Problem>& memory) {
  constexpr double slope = 1e-9;
  constexpr int most_turns = 10;
  const DescentLimits by_gradient{.iterations = std::max(iterations / most_turns, 10), .slope = slope};
  const DescentLimits by_newton{.iterations = std::max(iterations / (2 * most_turns), 5), .slope = slope};
  for (int turn = 0; turn < most_turns; ++turn) {
    Eigen::VectorXd x = found.x;
    const Descent ended = descend_gradient(problem, variables.bounds(), by_gradient, x, memory);
    found.keep_better(x, memory.r.squaredNorm(), ended);
    // Not better and yet at the bottom: it was there already.
    if (found.ended != Descent::met) found.ended = ended;
    if (ended != Descent::exhausted) return;
    x = found.x;
    const Descent newton = descend(problem, variables.bounds(), by_newton, x, memory);
    found.keep_better(x, memory.r.squaredNorm(), newton);
    if (newton == Descent::met) return;
  }
  if (is_level(problem, variables, found.x, memory)) found.ended = Descent::stationary;
}

/// The nearest state to a problem known not to be met: the best of the valleys below a few starts.
template <class Problem>
Found nearest(Problem& problem, const ArmVariables& variables, InverseStarts& starts, int max_starts,
              DescentMemory<Problem>& memory) {
  constexpr DescentLimits rough{.iterations = 20, .slope = 1e-3};
  constexpr DescentLimits finer{.iterations = 60, .slope = 1e-6};
  Found found;
  Eigen::VectorXd x(variables.size());
  while (found.starts < max_starts) {
    starts.next(x);
    descend(problem, variables.bounds(), rough, x, memory);
    const Descent ended = descend_gradient(problem, variables.bounds(), finer, x, memory);
    found.keep_better(x, memory.r.squaredNorm(), ended);
    ++found.starts;
  }
  settle(problem, variables, settling_iterations, found, memory);
  return found;
}

/// Why what was found misses its target: the descent did not come to an end, or limits keep it from going on,
/// or nothing does and the target is out of reach.
template <class Problem>
InverseOutcome outcome_of_missed(Problem& problem, const ArmVariables& variables, const Found& found,
                                 DescentMemory<Problem>& memory) {
  if (found.ended == Descent::exhausted) return InverseOutcome::no_convergence;
  constexpr double least_pressure = 1e-6;  // Of the residual's norm.
  problem.linearise(found.x, memory.r, memory.J);
  const Eigen::VectorXd gradient = memory.J.transpose() * memory.r;
  return pressure(variables.bounds(), found.x, gradient) > least_pressure * memory.r.norm()
             ? InverseOutcome::at_limit
             : InverseOutcome::not_reachable;
}

}  // namespace flexura
