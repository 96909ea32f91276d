#pragma once

#include <functional>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/safety/spans.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// Share of a limit by which a value may exceed it: limits are given in degrees, and values computed in
/// radians.
inline constexpr double limit_tolerance = 1e-9;

/// A limited quantity of one section.
struct LimitWatch {
  Hazard hazard = Hazard::bend;
  std::size_t section = 0;                             ///< From 0.
  double limit = 0;                                    ///< As reported.
  double sign = 1;                                     ///< -1: the value must not fall below the limit.
  std::function<double(const ArmState& state)> value;  ///< Returns the value in the hazard's unit.
  /// Returns a bound on |d value/dt| in [start, end] of a motion with known rates.
  std::function<double(const Motion& motion, double start, double end)> rate;

  /// Returns the threshold: the limit is broken if sign * value exceeds it. A tube folds at its limit; all
  /// other values may reach theirs.
  [[nodiscard]] double threshold() const;
};

/// Returns all limits on the states of the arm: bends, stretches, folding (curvature times radius below 1).
[[nodiscard]] std::vector<LimitWatch> limit_watches(const Arm& arm);

/// Returns the bounds of `motion` in [start, end] s of its time, or 0 if it has none.
[[nodiscard]] SectionRates rates_of(const Motion& motion, std::size_t section, double start, double end);

/// Returns a section's bend rate in a motion with known rates, rad/s.
[[nodiscard]] WatchedQuantity bend_rate(const Motion& motion, std::size_t section);
/// Returns a section's stretch rate in a motion with known rates, 1/s.
[[nodiscard]] WatchedQuantity stretch_rate(const Motion& motion, std::size_t section);

}  // namespace flexura
