#pragma once

#include <cstdint>
#include <string_view>

#include "flexura/base/image.h"
#include "flexura/camera/view.h"
#include "flexura/estimate/observation.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// Returns the observation of the backbone in a picture with this `view`. It has the centerline where both
/// borders are visible, corrected for the lens, these borders, and the arm's ends. Pixels without a ray are
/// omitted. Ends are omitted unless the axis covers nearly all of the silhouette, as they may be those of a
/// fold.
[[nodiscard]] Observation observation_of(const ArmObservation& arm, const View& view);

/// Returns this observation with the coloured bands around the arm in `picture`, in which it was found. Bands
/// that may be two are omitted.
[[nodiscard]] Observation observation_of(const ArmObservation& arm, const View& view,
                                         const Image<std::uint8_t>& picture);

/// Returns whether the lens has a ray for every pixel of the picture. Checks the corners: the visible area is
/// round, or nearly so with the tangential distortion of real lenses.
[[nodiscard]] bool shows_all(const View& view);

/// Note for an observation from which pixels were omitted for that reason.
inline constexpr std::string_view rays_lacking =
    "the camera's distortion has no ray for some pixels of the arm: they count for nothing";

}  // namespace flexura
