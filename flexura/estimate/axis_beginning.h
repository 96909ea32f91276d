#pragma once

#include <Eigen/Core>
#include <optional>

#include "flexura/estimate/observation.h"

namespace flexura {

/// Distance of an image point from a curve, perpendicular to the curve.
struct Aside {
  double distance = 0;  ///< px, >= 0.
  double sigma = 0;     ///< Standard deviation that follows from the noise of the curve's points, px.
};

/// Returns the distance of a pixel from the visible backbone at its beginning in `seen`. The curve is
/// extended beyond its first point by a parabola through its first 40 px, or eight points. Empty if the
/// visible curve is shorter than that, or turns by more than half a radian in that part. Also empty if the
/// pixel is not near the beginning, which means from 15 px before the beginning to 5 px behind it.
[[nodiscard]] std::optional<Aside> aside_of_beginning(const Observation& seen, const Eigen::Vector2d& pixel);

}  // namespace flexura
