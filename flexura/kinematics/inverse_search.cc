#include "flexura/kinematics/inverse_search.h"

#include <algorithm>
#include <cmath>

namespace flexura {
namespace {

// Whether x is the bottom of a valley but for its last digits: along the slope that the bounds leave, |r|
// changes by no more than a millionth of itself a radian.
bool is_level(BoundedProblem& problem, const ArmVariables& variables, const Eigen::VectorXd& x,
              DescentMemory& memory) {
  constexpr double least_slope = 1e-6;
  memory.linearise(problem, x);
  memory.find_gradient();
  Eigen::VectorXd lower = x - memory.gradient;
  project(variables.bounds(), lower);
  return (lower - x).norm() <= least_slope * std::sqrt(memory.square);
}

}  // namespace

void search(BoundedProblem& problem, const ArmVariables& variables, InverseStarts& starts, int max_starts,
            DescentMemory& memory, Found& found) {
  // Short descents answer all but the tightly rolled arms, which need patience.
  constexpr int patient_from = 30;
  constexpr DescentLimits brief{.iterations = 60};
  constexpr DescentLimits patient{.iterations = 250};
  Eigen::VectorXd x(variables.size());
  while (!found.is_met() && found.starts < max_starts) {
    starts.next(x);
    const DescentLimits& limits = found.starts < patient_from ? brief : patient;
    const Descent ended = descend(problem, variables.bounds(), limits, x, memory);
    found.keep_better(x, memory.square, ended);
    ++found.starts;
  }
}

void settle(BoundedProblem& problem, const ArmVariables& variables, int iterations, Found& found,
            DescentMemory& memory) {
  constexpr double slope = 1e-9;
  constexpr int most_turns = 10;
  const DescentLimits by_gradient{.iterations = std::max(iterations / most_turns, 10), .slope = slope};
  const DescentLimits by_newton{.iterations = std::max(iterations / (2 * most_turns), 5), .slope = slope};
  for (int turn = 0; turn < most_turns; ++turn) {
    Eigen::VectorXd x = found.x;
    const Descent ended = descend_gradient(problem, variables.bounds(), by_gradient, x, memory);
    found.keep_better(x, memory.square, ended);
    // Not better and yet at the bottom: it was there already.
    if (found.ended != Descent::met) found.ended = ended;
    if (ended != Descent::exhausted) return;
    x = found.x;
    const Descent newton = descend(problem, variables.bounds(), by_newton, x, memory);
    found.keep_better(x, memory.square, newton);
    if (newton == Descent::met) return;
  }
  if (is_level(problem, variables, found.x, memory)) found.ended = Descent::stationary;
}

Found nearest(BoundedProblem& problem, const ArmVariables& variables, InverseStarts& starts, int max_starts,
              DescentMemory& memory) {
  constexpr DescentLimits rough{.iterations = 20, .slope = 1e-3};
  constexpr DescentLimits finer{.iterations = 60, .slope = 1e-6};
  Found found;
  Eigen::VectorXd x(variables.size());
  while (found.starts < max_starts) {
    starts.next(x);
    descend(problem, variables.bounds(), rough, x, memory);
    const Descent ended = descend_gradient(problem, variables.bounds(), finer, x, memory);
    found.keep_better(x, memory.square, ended);
    ++found.starts;
  }
  settle(problem, variables, settling_iterations, found, memory);
  return found;
}

InverseOutcome outcome_of_missed(BoundedProblem& problem, const ArmVariables& variables, const Found& found,
                                 DescentMemory& memory) {
  if (found.ended == Descent::exhausted) return InverseOutcome::no_convergence;
  constexpr double least_pressure = 1e-6;  // Of the residual's norm.
  problem.linearise(found.x, memory.r, memory.J);
  memory.find_gradient();
  return pressure(variables.bounds(), found.x, memory.gradient) > least_pressure * memory.r.norm()
             ? InverseOutcome::at_limit
             : InverseOutcome::not_reachable;
}

}  // namespace flexura
