#pragma once

#include "flexura/kinematics/motion.h"
#include "flexura/model/actuation.h"

namespace flexura {

/// The shapes that an arm goes through when it is commanded to follow `command`. It knows the rates that the
/// command knows.
[[nodiscard]] MotionPtr shaped_motion(const Actuation& actuation, MotionPtr command);

}  // namespace flexura
