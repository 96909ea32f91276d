#pragma once

#include <functional>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/safety/spans.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// What is above its limit by no more than this part of it is on it: limits are typed in degrees, and values
/// computed in radians.
inline constexpr double limit_tolerance = 1e-9;

/// A quantity of one section that has a limit.
struct LimitWatch {
  Hazard hazard = Hazard::bend;
  std::size_t section = 0;                             ///< From 0.
  double limit = 0;                                    ///< As reported.
  double sign = 1;                                     ///< -1: the value must not fall below the limit.
  std::function<double(const ArmState& state)> value;  ///< Of the section in a state, in the hazard's unit.
  /// A bound on |d value/dt| anywhere in [start, end] of a motion that knows its rates.
  std::function<double(const Motion& motion, double start, double end)> rate;

  /// sign * value above this breaks the limit. A tube folds where it reaches its limit, all others may.
  [[nodiscard]] double threshold() const;
};

/// Every limit on the states of the arm: bends, stretches, folding (curvature times radius below 1).
[[nodiscard]] std::vector<LimitWatch> limit_watches(const Arm& arm);

/// The bounds that `motion` knows in [start, end] s of its own time; those of one that knows none are 0.
[[nodiscard]] SectionRates rates_of(const Motion& motion, std::size_t section, double start, double end);

/// A section's bend rate in a motion that knows its rates, rad/s.
[[nodiscard]] WatchedQuantity bend_rate(const Motion& motion, std::size_t section);
/// Its stretch rate, 1/s.
[[nodiscard]] WatchedQuantity stretch_rate(const Motion& motion, std::size_t section);

}  // namespace flexura
