#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/arm_finder.h"
#include "flexura/vision/arm_skin.h"
#include "flexura/vision/markers.h"

namespace flexura {

/// Spots on the visible skin, anywhere across it, but not those that reach one of the `bands` (stretches of
/// the middle line) or from one side of the arm to the other. What is nearer than `bound` to the colour of
/// the skin beside is none.
[[nodiscard]] std::vector<MarkerSighting> find_spots(const Image<std::uint8_t>& picture,
                                                     const ArmSighting& arm, const ArmSkin& skin,
                                                     std::span<const Stretch> bands, double bound);

}  // namespace flexura
