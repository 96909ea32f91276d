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

/// Answers lines of `flexura linearise` about one arm: JSON objects with at most one of "tensions":[...] and
/// "displacements":[...]. Optional keys are "tip_force", "tip_moment" and "gravity" (docs/command-line.md).
/// All vectors are in the frame of the arm's base. An answer does not depend on earlier lines.
class LineariseAnswers {
 public:
  /// Throws std::invalid_argument if the arm has no computable rod (rod_of, rod_problems) or no mass
  /// (RodDynamics). Also throws std::invalid_argument for tendons with friction, which have no linear model.
  LineariseAnswers(const ArmConfig& arm, const std::optional<DriveConfig>& drive);

  /// Returns one line of JSON without its line end: {"converged":..,"reason":..}. If an equilibrium was
  /// found, the answer also has "stable":..,"tip":.., the names of "states", "inputs" and "outputs", the
  /// matrices "A", "B" and "C" by rows, "eigenvalues":[[real,imaginary],..], "frequencies_hz" and
  /// "damping_ratios". The answer to an invalid line is {"error":"..."}. No line makes this function throw an
  /// exception.
  [[nodiscard]] std::string answer(std::string_view line);

 private:
  Rod rod_;
  RodLoads loads_;
  RodStatics statics_;
  RodDynamics dynamics_;
};

}  // namespace flexura
