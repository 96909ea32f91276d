#pragma once

#include <limits>

// The method of K. Levenberg (1944) and D. W. Marquardt (1963), shared by all minimisers here. The problem
// defines the unknowns and the solution of a damped step.
namespace flexura {

/// Results of a step before its acceptance.
struct TriedStep {
  double cost = std::numeric_limits<double>::infinity();  ///< Cost after the step; infinite if it is invalid.
  /// Decrease predicted by the linear model.
  double promised = std::numeric_limits<double>::infinity();
};

/// Damping of the steps.
struct Damping {
  double start = 1e-4;
  double most = 1e12;  ///< Limit of the damping.
  double rise = 10;    ///< Factor after a rejected step; multiplied by `growth` for each consecutive one.
  double growth = 1;
  /// Returns the damping after an accepted step, from the previous one and the ratio of actual to predicted
  /// decrease (-1 without a predicted decrease).
  double (*eased)(double damping, double ratio) = nullptr;
};

/// Reason for the end of a descent.
enum class DescentEnd {
  done,       ///< Ended by the problem.
  stuck,      ///< No step lowers the cost.
  exhausted,  ///< Step limit reached.
};

/// Tries steps from a point with this `cost` and accepts each that lowers it.
///
/// - `try_step(damping)` solves for a step and returns its result, a TriedStep.
/// - `keep(step, cost)` takes the step just tried and linearises there. It sets `cost` to the value that the
///   next one has to lower, and returns true if it was the last.
/// - `leave(step, cost)` returns true if smaller steps need not be tried.
template <class Try, class Keep, class Leave>
DescentEnd levenberg_marquardt(double cost, const Damping& damping, int most_tries, const Try& try_step,
                               const Keep& keep, const Leave& leave) {
  double value = damping.start, rise = damping.rise;
  for (int tries = 0; tries < most_tries; ++tries) {
    const TriedStep step = try_step(value);
    if (step.cost < cost) {
      value = damping.eased(value, step.promised > 0 ? (cost - step.cost) / step.promised : -1);
      rise = damping.rise;
      if (keep(step, cost)) return DescentEnd::done;
    } else {
      if (leave(step, cost)) return DescentEnd::done;
      value *= rise, rise *= damping.growth;
      if (!(value <= damping.most)) return DescentEnd::stuck;
    }
  }
  return DescentEnd::exhausted;
}

}  // namespace flexura
