#pragma once

#include "flexura/camera/camera.h"
#include "flexura/camera/view.h"
#include "flexura/study/study_config.h"
#include "flexura/study/study_target.h"

namespace flexura {

/// What the camera sees from where it stands at the start, with one parameter (a member of VaryConfig) at
/// `value`. std::out_of_range: a zoom outside the lens's table; std::invalid_argument: a focal length that is
/// not positive, a camera in the target's centre that is to orbit it or to stand off from it.
[[nodiscard]] View view_with(const Camera& camera, VaryConfig::Values VaryConfig::* parameter, double value,
                             const StudyTarget& target);

/// The motor-driven axis that a parameter belongs to; null for the others.
[[nodiscard]] const AxisConfig* moved_axis(const Camera& camera, VaryConfig::Values VaryConfig::* parameter);

}  // namespace flexura
