#pragma once

#include <optional>
#include <span>
#include <string>

#include "flexura/camera/view.h"
#include "flexura/estimate/shape_variables.h"
#include "flexura/estimate/sighting.h"

namespace flexura {

/// Whether a camera's description is one for pictures of another size than the view's; for which, as far as
/// its principal point tells.
[[nodiscard]] std::optional<std::string> doubt_of_size(const View& view);

/// Whether a known arm is seen much thicker or thinner than it is described, and what radius is seen; of arms
/// without a radius none.
[[nodiscard]] std::optional<std::string> doubt_of_radius(std::span<const Sighting> sightings,
                                                         const Shape& shape);

}  // namespace flexura
