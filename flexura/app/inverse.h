#pragma once

#include <string>
#include <string_view>

#include "flexura/model/arm.h"
#include "flexura/model/arm_model.h"

namespace flexura {

/// Answers one line of `flexura ik`: a JSON object {"position":[x,y,z]} with an optional "direction":[x,y,z]
/// or "rotation":[w,x,y,z], or an object {"curve":[[x,y,z],...]}. Both forms may have "prefer", "start" and
/// "all" (docs/command-line.md). The answer is one line of JSON without its line end:
/// {"converged":..,"reason":..,"bends":[[bx,by],...],"stretches":[..],"position_error":..,"angle_error":..}.
/// For a planar arm the answer has "archings" instead of "bends". If the search did not converge, the answer
/// also has "nearest" and "distance"; with "all" it also has "solutions". The answer to an invalid line is
/// {"error":"..."}. No line makes this function throw an exception.
[[nodiscard]] std::string answer_inverse(const ArmModel& arm, std::string_view line);
/// Answers one line of `flexura ik` for an arm of arcs.
[[nodiscard]] inline std::string answer_inverse(const Arm& arm, std::string_view line) {
  return answer_inverse(ArmModel(arm), line);
}

/// Returns why a line of `flexura ik` cannot be answered, or "". No line makes this function throw an
/// exception.
[[nodiscard]] std::string inverse_problem(const Arm& arm, std::string_view line);

}  // namespace flexura
