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

/// Finds spots anywhere on the arm's visible surface. A spot must differ by more than `bound` from the
/// adjacent surface colour. Excludes spots that touch one of the `bands` (ranges of samples on the middle
/// line) or both sides of the arm.
[[nodiscard]] std::vector<MarkerObservation> find_spots(const Image<std::uint8_t>& picture,
                                                        const ArmObservation& arm, const ArmSkin& skin,
                                                        std::span<const Stretch> bands, double bound);

}  // namespace flexura
