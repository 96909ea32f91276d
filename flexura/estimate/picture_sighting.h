#pragma once

#include <cstdint>
#include <string_view>

#include "flexura/base/image.h"
#include "flexura/camera/view.h"
#include "flexura/estimate/sighting.h"
#include "flexura/vision/arm_finder.h"

namespace flexura {

/// What a picture by `view` shows of the backbone: the median axis where both borders are seen, corrected for
/// the lens, these borders, and the arm's ends; of all these only what the lens has rays for. Where the axis
/// explains less than nearly all of the silhouette its ends may be a fold's, not the arm's: then there are
/// none.
[[nodiscard]] Sighting sighting_of(const ArmSighting& arm, const View& view);

/// The same with the coloured bands around the arm in `picture`, in which it was found; bands that may be two
/// in one are left out.
[[nodiscard]] Sighting sighting_of(const ArmSighting& arm, const View& view,
                                   const Image<std::uint8_t>& picture);

/// Whether the lens has a ray for every pixel of the picture: what it shows is round, or nearly so for all
/// that tangential distortion of real lenses does, so the corners tell.
[[nodiscard]] bool shows_all(const View& view);

/// What to say of a picture whose sighting leaves something out for that.
inline constexpr std::string_view rays_lacking =
    "the camera's distortion has no ray for some pixels of the arm: they count for nothing";

}  // namespace flexura
