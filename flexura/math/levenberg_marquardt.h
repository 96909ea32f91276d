#pragma once

#include <limits>

// The method of K. Levenberg (1944) and D. W. Marquardt (1963), once for all who make a cost small. What the
// unknowns are, and how a damped step is solved for, is the problem's own.
namespace flexura {

/// What is known of a step before it is decided on.
struct TriedStep {
  double cost = std::numeric_limits<double>::infinity();  ///< Where it leads; infinite: nowhere.
  /// How much lower the linear model has it.
  double promised = std::numeric_limits<double>::infinity();
};

/// How steps are damped.
struct Damping {
  double start = 1e-4;
  double most = 1e12;  ///< Beyond it no step is tried.
  double rise = 10;    ///< The factor after a step that is left; each time in a row `growth` times as much.
  double growth = 1;
  /// The damping after a step that is kept, from that before and the ratio of what was gained to what was
  /// promised; of that -1 where nothing was.
  double (*eased)(double damping, double ratio) = nullptr;
};

/// Why a descent ended.
enum class DescentEnd {
  done,       ///< The problem says so.
  stuck,      ///< No step lowers the cost.
  exhausted,  ///< As many steps are tried as may be.
};

/// Tries steps from a place of that `cost` and keeps each that lowers it.
/// try_step(damping): solves for a step, and says where it leads: a TriedStep.
/// keep(step, cost): goes the step just tried, linearises there, and sets `cost` to what the next one has to
/// lower; whether it was the last. leave(step, cost): whether smaller ones need not be tried either.
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
