#pragma once

#include <cstdint>
#include <string_view>

#include "flexura/base/image.h"
#include "flexura/camera/view.h"
#include "flexura/estimate/observation.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Returns the observation of the backbone in a picture with this `view`. The observation has the borders,
/// the arm's ends, and the centerline where both borders are visible. The centerline is moved to the image of
/// the backbone (vision/backbone_image.h). Pixels for which the lens has no ray are omitted. The ends are
/// kept only if the centerline covers nearly all of the silhouette: otherwise an end may be a fold of the
/// arm.
[[nodiscard]] Observation observation_of(const ArmObservation& arm, const View& view);

/// Returns this observation with the coloured bands around the arm in `picture`, the picture in which the arm
/// was found. Omits bands that may be two merged bands.
[[nodiscard]] Observation observation_of(const ArmObservation& arm, const View& view,
                                         const Image<std::uint8_t>& picture);

/// Returns whether the lens has a ray for every pixel of the picture. Checks only the corners, because the
/// area with rays is round, or nearly round with the tangential distortion of real lenses.
[[nodiscard]] bool shows_all(const View& view);

/// Note for an observation from which pixels were omitted because the lens has no ray for them.
inline constexpr std::string_view rays_lacking =
    "the camera's distortion has no ray for some pixels of the arm: they count for nothing";

}  // namespace flexura
