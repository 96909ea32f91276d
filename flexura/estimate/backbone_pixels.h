#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/camera/view.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Returns the image of an arm in this state, px: `count` + 1 points at equal steps of the arm's length, from
/// base to tip. Points behind the camera are omitted.
[[nodiscard]] std::vector<Eigen::Vector2d> backbone_pixels(const Arm& arm, const ArmState& state,
                                                           const View& view, int count);

}  // namespace flexura
