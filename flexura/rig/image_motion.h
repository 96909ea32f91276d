#pragma once

#include "flexura/render/scene.h"
#include "flexura/sim/simulated_camera.h"

namespace flexura {

/// Returns the highest image speed in a shot between the start of its exposure and the end of its last row's,
/// px/s. It is the highest of the arm's joints and of points of `stand`, a scene without an arm. Enough times
/// are sampled to detect a motion there and back.
[[nodiscard]] double fastest_image_motion(const Shot& shot, const Scene& stand);

}  // namespace flexura
