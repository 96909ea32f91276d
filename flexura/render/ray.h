#pragma once

#include <Eigen/Core>
#include <limits>

namespace flexura {

/// Depth where there is no surface.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// A ray through a point of the image: the points depth * direction, depth > 0, in C.
struct Ray {
  Eigen::Vector3d direction;  ///< (a, b, 1): the parameter along the ray is the depth.
  Eigen::Matrix2d by_pixel;   ///< Derivative of (a, b) by (u, v), 1/px.
};

}  // namespace flexura
