#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/estimate/sighting.h"

namespace flexura {

/// A point in space seen by two cameras.
struct SpacePoint {
  Eigen::Vector3d position = {0, 0, 0};      ///< p_WP, m.
  double gap = 0;                            ///< Between the two rays, m.
  std::array<std::size_t, 2> seen = {0, 0};  ///< Which point of either sighting it is.
};

/// Two sightings of one curve, brought together.
struct Correspondence {
  std::vector<SpacePoint> points;  ///< Along the curve.
  double cost = 0;                 ///< Mean square of the distances from the epipolar lines, px^2.
};

/// Which points of two sightings belong together: the pairing, monotonous along both curves, with the least
/// sum of squared distances from the epipolar lines (dynamic programming); ends that both see belong
/// together. Empty where the lenses show nothing.
[[nodiscard]] Correspondence correspondence(const Sighting& a, const Sighting& b);

/// Where two rays come nearest: from `eye` along `direction` (any length), in W. None for parallel rays.
struct SpaceRay {
  Eigen::Vector3d eye, direction;
};
[[nodiscard]] std::optional<SpacePoint> meeting(const SpaceRay& a, const SpaceRay& b);

}  // namespace flexura
