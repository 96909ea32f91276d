#pragma once

#include "flexura/render/scene.h"
#include "flexura/sim/simulated_camera.h"

namespace flexura {

/// Returns the highest image speed in a shot, px/s, from the start of the exposure to its end in the last
/// row. It is the largest speed of the arm's joints and of points of `stand`, a scene without an arm. Enough
/// times are sampled to detect a motion that returns to its start.
[[nodiscard]] double fastest_image_motion(const Shot& shot, const Scene& stand);

}  // namespace flexura
