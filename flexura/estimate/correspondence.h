#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <vector>

#include "flexura/estimate/observation.h"

namespace flexura {

/// A point in space that two cameras see.
struct SpacePoint {
  Eigen::Vector3d position = {0, 0, 0};      ///< p_WP, m.
  std::array<std::size_t, 2> seen = {0, 0};  ///< Index of the point in each observation's list of points.
};

/// Returns corresponding points of two observations of one curve. The correspondence is monotonic along both
/// curves, and has the least sum of squared distances from the epipolar lines (dynamic programming). An end
/// of the arm that is visible in both observations corresponds to itself. The result is empty if a lens has
/// no rays for the points.
[[nodiscard]] std::vector<SpacePoint> correspondence(const Observation& a, const Observation& b);

}  // namespace flexura
