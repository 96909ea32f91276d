#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "flexura/estimate/sighting.h"

namespace flexura {

/// A point in space seen by two cameras.
struct SpacePoint {
  Eigen::Vector3d position = {0, 0, 0};      ///< p_WP, m.
  std::array<std::size_t, 2> seen = {0, 0};  ///< Which point of either sighting it is.
};

/// Which points of two sightings of one curve belong together, along it: the pairing, monotonous along both
/// curves, with the least sum of squared distances from the epipolar lines (dynamic programming); ends that
/// both see belong together. Empty where the lenses show nothing.
[[nodiscard]] std::vector<SpacePoint> correspondence(const Sighting& a, const Sighting& b);

}  // namespace flexura
