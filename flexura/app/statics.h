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

/// Answers lines of `flexura statics` about one arm: JSON objects {"tensions":[...]} or
/// {"displacements":[...]} or {"target":{...}} (StaticsTarget), or none of them, with optional "tip_force",
/// "tip_moment", "gravity" and "at" (docs/command-line.md), all in the frame of the arm's base. An answer
/// depends on its line alone.
class StaticsAnswers {
 public:
  /// Throws std::invalid_argument if the arm has no computable rod (rod_of, rod_problems).
  StaticsAnswers(const ArmConfig& arm, const std::optional<DriveConfig>& drive);

  /// Returns one line of JSON without its line end: {"converged":..,"reason":..}. If converged, it also has
  /// "tip":{"position":[..],"rotation":[w,x,y,z]},"tensions":[..],"displacements":[..],"strain_energy":..,
  /// "stable":..,"snapped":..,"ambiguous":.. and "at":[poses] where asked for. Of a target the tensions are
  /// those of least effort that reach it, or come nearest, and there are "reached":.., "why_not":"..." if it
  /// is not, "residual":.. (m) and, where an orientation was asked for, "residual_angle":.. (rad).
  /// {"error":"..."} for a line that cannot be answered. Never throws on account of the line.
  [[nodiscard]] std::string answer(std::string_view line);
  /// Returns why the line cannot be answered; "" if it can.
  [[nodiscard]] std::string problem(std::string_view line) const;

 private:
  InverseStaticsResult aimed(const StaticsTarget& target, const RodLoads& loads);

  Rod rod_;
  RodLoads loads_;
  RodStatics statics_;
};

}  // namespace flexura
