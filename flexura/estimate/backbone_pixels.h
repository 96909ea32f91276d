#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Where a view sees an arm in this state: `count` + 1 points of equal shares of its length from base to tip,
/// px, without those behind the camera.
[[nodiscard]] std::vector<Eigen::Vector2d> backbone_pixels(const Arm& arm, const ArmState& state,
                                                           const View& view, int count);

}  // namespace flexura
