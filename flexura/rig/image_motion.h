#pragma once

#include "flexura/render/scene.h"
#include "flexura/sim/simulated_camera.h"

namespace flexura {

/// Returns the highest speed in the image during a shot, px/s. The shot lasts from the start of the exposure
/// to the end of the exposure of the last row. The result is the largest speed of the images of the arm's
/// joints and of points of `stand`. `stand`: the scene without the arm. Enough times are sampled to detect
/// motions that return to their start.
[[nodiscard]] double fastest_image_motion(const Shot& shot, const Scene& stand);

}  // namespace flexura
