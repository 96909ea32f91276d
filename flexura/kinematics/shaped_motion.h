#pragma once

#include "flexura/kinematics/motion.h"
#include "flexura/model/actuation.h"

namespace flexura {

/// Returns the motion of the arm's shape that results from a motion of commands. Bounds on the rates of the
/// shape are known if bounds on the rates of the commands are known.
[[nodiscard]] MotionPtr shaped_motion(const Actuation& actuation, MotionPtr command);

}  // namespace flexura
