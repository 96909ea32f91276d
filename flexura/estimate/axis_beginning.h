#pragma once

#include <Eigen/Core>
#include <optional>

#include "flexura/estimate/observation.h"

namespace flexura {

/// Distance of an image point from a curve, perpendicular to the curve.
struct Aside {
  double distance = 0;  ///< Distance, px; >= 0.
  double sigma = 0;     ///< Standard deviation of the distance due to the noise of the curve's points, px.
};

/// Returns the distance of a pixel from the visible backbone at the backbone's beginning in `seen`. The curve
/// is extended beyond its first point by a parabola. The parabola is fitted to the first part of the curve,
/// which has a length of at least 40 px and at least eight points. Returns std::nullopt if the visible curve
/// is shorter than this part, or if this part turns by more than 0.5 rad. Also returns std::nullopt unless
/// the pixel is between 15 px before and 5 px behind the beginning.
[[nodiscard]] std::optional<Aside> aside_of_beginning(const Observation& seen, const Eigen::Vector2d& pixel);

}  // namespace flexura
