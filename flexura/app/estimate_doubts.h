#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>

#include "flexura/estimate/shape_variables.h"
#include "flexura/estimate/sighting.h"

namespace flexura {

/// Whether a known arm is seen much thicker or thinner than it is described, and what radius is seen; of arms
/// without a radius none.
[[nodiscard]] std::optional<std::string> doubt_of_radius(std::span<const Sighting> sightings,
                                                         const Shape& shape);

/// Where in a picture the base (p_WB, m) would be seen that shows the arm nowhere near, for shapes that are
/// not found; none where it is near in all, or beside them.
[[nodiscard]] std::optional<std::string> doubt_of_base(std::span<const Sighting> sightings,
                                                       const Eigen::Vector3d& p_WB);

}  // namespace flexura
