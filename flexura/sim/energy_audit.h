#pragma once

#include <optional>

namespace flexura {

/// Detects a motion whose energy grows although nothing drives it. Steps that do not resolve the fastest
/// modes of a rod can cause this if they have no numerical damping (docs/mechanics.md, "Steps").
class EnergyAudit {
 public:
  /// Starts a new span of time without a supply of energy.
  void restart() { least_.reset(); }
  /// Adds the state at the end of a step. `total`: all energy that the motion conserves, J. `moving`: its
  /// part that changes with the motion without weight: kinetic energy and strain, J; >= 0.
  void add(double total, double moving);
  /// Returns whether the energy has grown in any span, by more than errors of usual steps.
  [[nodiscard]] bool has_grown() const { return has_grown_; }

 private:
  std::optional<double> least_;  // Least total energy of the span, J.
  double scale_ = 0;             // Largest `moving` of the span, J.
  bool has_grown_ = false;
};

}  // namespace flexura
