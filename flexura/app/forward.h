#pragma once

#include <string>
#include <string_view>

#include "flexura/model/arm.h"
#include "flexura/model/arm_model.h"

namespace flexura {

/// Answers one line of `flexura fk`. The line is a JSON object {"cord_angles":[...]}, {"archings":[...]}
/// (planar) or {"bends":[[bx,by],...],"stretches":[...]} with an optional "at":[s,...]; angles in rad,
/// lengths in m. The answer is one line of JSON without its line end:
/// {"tip":{"position":[x,y,z],"rotation":[w,x,y,z]},"bases":[[x,y,z],...],"at":[...]} in world axes. `bases`
/// has each section's base point and, as the last point, the tip. The answer to an invalid line is
/// {"error":"..."}. No line makes this function throw an exception.
[[nodiscard]] std::string answer_forward(const ArmModel& arm, std::string_view line);
/// Answers one line of `flexura fk` for an arm of arcs.
[[nodiscard]] inline std::string answer_forward(const Arm& arm, std::string_view line) {
  return answer_forward(ArmModel(arm), line);
}

}  // namespace flexura
