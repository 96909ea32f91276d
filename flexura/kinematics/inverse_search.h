#pragma once

#include <Eigen/Core>
#include <limits>

#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/kinematics/inverse_starts.h"
#include "flexura/kinematics/projected_gradient.h"

namespace flexura {

/// A bound whose pressure is above this part of the residual's norm counts as what holds a state.
inline constexpr double least_pressure = 1e-6;

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

/// Brings what was not met to the bottom of its valley.
template <class Problem>
void settle(Problem& problem, const ArmVariables& variables, Found& found, DescentMemory<Problem>& memory) {
  constexpr DescentLimits limits{.iterations = 1000, .slope = 1e-9};
  Eigen::VectorXd x = found.x;
  const Descent ended = descend_gradient(problem, variables.bounds(), limits, x, memory);
  found.keep_better(x, memory.r.squaredNorm(), ended);
  // Not better and yet at the bottom: it was there already.
  if (found.ended != Descent::met) found.ended = ended;
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
  settle(problem, variables, found, memory);
  return found;
}

}  // namespace flexura
