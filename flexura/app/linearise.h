#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/statics.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/drive_config.h"

namespace flexura {

/// Answers lines of `flexura linearise` about one arm: JSON objects {"tensions":[...]} or
/// {"displacements":[...]}, or neither, with optional "tip_force", "tip_moment" and "gravity"
/// (docs/command-line.md), all in the frame of the arm's base. An answer depends on its line alone.
class LineariseAnswers {
 public:
  /// std::invalid_argument: the arm has no rod that can be computed (rod_of, rod_problems), or one that
  /// cannot move (RodDynamics): it has no mass; or tendons with friction, which has no linear model.
  LineariseAnswers(const ArmConfig& arm, const std::optional<DriveConfig>& drive);

  /// One line of JSON without its line end: {"converged":..,"reason":..} and, of an equilibrium that was
  /// found, "stable":..,"tip":.., the names of "states", "inputs" and "outputs", the matrices "A", "B" and
  /// "C" by rows, "eigenvalues":[[real,imaginary],..], "frequencies_hz" and "damping_ratios"; {"error":"..."}
  /// for a line that cannot be answered. Never throws on account of the line.
  [[nodiscard]] std::string answer(std::string_view line);

 private:
  Rod rod_;
  RodLoads loads_;
  RodStatics statics_;
  RodDynamics dynamics_;
};

}  // namespace flexura
