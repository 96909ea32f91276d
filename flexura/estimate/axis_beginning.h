#pragma once

#include <Eigen/Core>
#include <optional>

#include "flexura/estimate/sighting.h"

namespace flexura {

/// How far a place of an image is from a curve, across it.
struct Aside {
  double distance = 0;  ///< px, not negative.
  double sigma = 0;     ///< Standard deviation, by the curve's points, px.
};

/// How far a pixel is aside of what `seen` shows of the backbone where that begins, gone on beyond its first
/// point as it bends in its first 40 px, or eight points (a parabola). None where the curve is not seen so
/// far or turns by more than half a radian there, or the pixel is not nearly where it begins: from 15 px
/// before it to 5 px behind.
[[nodiscard]] std::optional<Aside> aside_of_beginning(const Sighting& seen, const Eigen::Vector2d& pixel);

}  // namespace flexura
