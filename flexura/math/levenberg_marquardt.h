#pragma once

#include <limits>

// The Levenberg-Marquardt method (Levenberg 1944, Marquardt 1963), which all minimizers of the
// library share. Each problem defines its unknowns and the computation of a damped step.
namespace flexura {

/// Result of a trial step.
struct TriedStep {
  /// Cost after the step; infinite if the step is invalid.
  double cost = std::numeric_limits<double>::infinity();
  /// Decrease of the cost that the linear model predicts; infinite if there is no prediction.
  double promised = std::numeric_limits<double>::infinity();
};

/// Parameters of the damping.
struct Damping {
  double start = 1e-4;  ///< Initial damping.
  double most = 1e12;   ///< Largest damping.
  /// Factor on the damping after a rejected step. Each further consecutive rejection multiplies the factor by
  /// `growth`.
  double rise = 10;
  double growth = 1;
  /// Function that returns the damping after an accepted step. The parameters of this function are the
  /// previous damping and the ratio of actual to predicted decrease of the cost (-1 if no decrease was
  /// predicted).
  double (*eased)(double damping, double ratio) = nullptr;
};

/// Reason for the end of a minimization.
enum class DescentEnd {
  done,       ///< The problem's `keep` or `leave` returned true.
  stuck,      ///< No step up to the largest damping decreases the cost.
  exhausted,  ///< The limit on the number of steps was reached.
};

/// Minimises a cost. `cost`: cost at the start. Accepts each trial step that decreases the cost. Tries at
/// most `most_tries` steps.
///
/// - `try_step(damping)` computes a trial step and returns its TriedStep.
/// - `keep(step, cost)` accepts the last trial step and linearises the problem at the new point. `keep` sets
///   `cost` to the cost that the next step must decrease, and returns true if this was the last step.
/// - `leave(step, cost)` returns true if smaller steps need not be tried after a rejected step.
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
