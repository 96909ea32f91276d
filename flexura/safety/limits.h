#pragma once

#include <functional>
#include <vector>

#include "flexura/kinematics/motion.h"
#include "flexura/model/arm.h"
#include "flexura/safety/spans.h"
#include "flexura/safety/violation.h"

namespace flexura {

/// Fraction of a limit by which a value may exceed the limit. This fraction allows for rounding errors,
/// because limits are given in degrees and values are computed in radians.
inline constexpr double limit_tolerance = 1e-9;

/// A limited quantity of one section.
struct LimitWatch {
  Hazard hazard = Hazard::bend;
  std::size_t section = 0;  ///< Index of the section; 0 at the base.
  double limit = 0;         ///< Limit for messages, in the hazard's unit.
  double sign = 1;          ///< Direction of the limit: 1 for an upper limit, -1 for a lower limit.
  std::function<double(const ArmState& state)> value;  ///< Returns the limited value in the hazard's unit.
  /// Returns a bound on |d value/dt| during [start, end], s, of a motion with known bounds on its rates.
  std::function<double(const Motion& motion, double start, double end)> rate;

  /// Returns the threshold: the limit is violated if sign * value exceeds the threshold. Folding is a
  /// violation at the limit itself; all other values may reach their limits.
  [[nodiscard]] double threshold() const;
};

/// Returns all limits on the states of the arm: on bends, on stretches, and on folding (curvature times
/// radius below 1).
[[nodiscard]] std::vector<LimitWatch> limit_watches(const Arm& arm);

/// Returns the bounds on the rates of a section of `motion` during [start, end], s; 0 if unknown.
[[nodiscard]] SectionRates rates_of(const Motion& motion, std::size_t section, double start, double end);

/// Returns a section's bend rate, rad/s, as a quantity of a motion with known bounds on its rates.
[[nodiscard]] WatchedQuantity bend_rate(const Motion& motion, std::size_t section);
/// Returns a section's stretch rate, 1/s, as a quantity of a motion with known bounds on its rates.
[[nodiscard]] WatchedQuantity stretch_rate(const Motion& motion, std::size_t section);

}  // namespace flexura
