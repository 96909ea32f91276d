#pragma once

#include "flexura/kinematics/motion.h"
#include "flexura/model/actuation.h"

namespace flexura {

/// Returns the motion of shapes of an arm that follows the commands `command`. Its rates are known if those
/// of the command are.
[[nodiscard]] MotionPtr shaped_motion(const Actuation& actuation, MotionPtr command);

}  // namespace flexura
