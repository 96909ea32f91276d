#pragma once

#include "flexura/camera/camera.h"
#include "flexura/camera/view.h"
#include "flexura/study/study_config.h"
#include "flexura/study/study_target.h"

namespace flexura {

/// Returns the camera's view at its initial axis positions, with one parameter set to `value`. The parameter
/// is a member of VaryConfig. Throws std::out_of_range for a zoom outside the lens's table. Throws
/// std::invalid_argument for a focal length that is not positive. Also throws std::invalid_argument for an
/// orbit or a distance if the camera is in the target's centre.
[[nodiscard]] View view_with(const Camera& camera, VaryConfig::Values VaryConfig::* parameter, double value,
                             const StudyTarget& target);

/// Returns the motor axis that moves a parameter; null if no axis moves it.
[[nodiscard]] const AxisConfig* moved_axis(const Camera& camera, VaryConfig::Values VaryConfig::* parameter);

}  // namespace flexura
