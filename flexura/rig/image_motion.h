#pragma once

#include "flexura/render/scene.h"
#include "flexura/sim/simulated_camera.h"

namespace flexura {

/// How fast what a shot shows moves in its image between the start of its exposure and the end of its last
/// row's, px/s: the fastest of the arm's joints and of points of `stand`, a scene without an arm, seen
/// between neighbours of so many times that a motion there and back is not taken for rest.
[[nodiscard]] double fastest_image_motion(const Shot& shot, const Scene& stand);

}  // namespace flexura
