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

/// Finds spots anywhere on the visible skin. Excludes those that reach one of the `bands` (stretches of the
/// middle line) or both sides of the arm. Also excludes colours within `bound` of the adjacent skin.
[[nodiscard]] std::vector<MarkerObservation> find_spots(const Image<std::uint8_t>& picture,
                                                        const ArmObservation& arm, const ArmSkin& skin,
                                                        std::span<const Stretch> bands, double bound);

}  // namespace flexura
