#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "flexura/app/statics_target.h"
#include "flexura/mechanics/inverse_statics.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/statics.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/drive_config.h"

namespace flexura {

/// Answers lines of `flexura statics` about one arm: JSON objects with at most one of "tensions":[...],
/// "displacements":[...] and "target":{...} (StaticsTarget). Optional keys are "tip_force", "tip_moment",
/// "gravity" and "at" (docs/command-line.md). All vectors are in the frame of the arm's base. An answer does
/// not depend on earlier lines.
class StaticsAnswers {
 public:
  /// Throws std::invalid_argument if the arm has no computable rod (rod_of, rod_problems).
  StaticsAnswers(const ArmConfig& arm, const std::optional<DriveConfig>& drive);

  /// Returns one line of JSON without its line end: {"converged":..,"reason":..}. If an equilibrium was
  /// found, the answer also has
  /// "tip":{"position":[..],"rotation":[w,x,y,z]},"tensions":[..],"displacements":[..],"strain_energy":..,
  /// "stable":..,"snapped":..,"ambiguous":.. and, if requested, "at":[poses]. For a target, the tensions have
  /// the least effort among those that reach the target or come nearest to it. The answer for a target also
  /// has the keys "reached" and "residual" (m), "why_not" if the target is not reached, and "residual_angle"
  /// (rad) if an orientation was requested. The answer to an invalid line is {"error":"..."}. No line makes
  /// this function throw an exception.
  [[nodiscard]] std::string answer(std::string_view line);
  /// Returns the error in the line; "" for a valid line.
  [[nodiscard]] std::string problem(std::string_view line) const;

 private:
  InverseStaticsResult aimed(const StaticsTarget& target, const RodLoads& loads);

  Rod rod_;
  RodLoads loads_;
  RodStatics statics_;
};

}  // namespace flexura
