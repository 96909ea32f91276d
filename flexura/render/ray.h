#pragma once

#include <Eigen/Core>
#include <limits>

namespace flexura {

/// The depth of nothing.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// What a point of the image sees: the points depth * direction, depth > 0, in C.
struct Ray {
  Eigen::Vector3d direction;  ///< (a, b, 1): the parameter along the ray is the depth.
  Eigen::Matrix2d by_pixel;   ///< Of (a, b) by (u, v), 1/px.
};

}  // namespace flexura
