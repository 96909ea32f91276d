#pragma once

#include <Eigen/Core>
#include <limits>

namespace flexura {

/// Depth of a ray that hits no surface.
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// A ray through a point of the image: all points depth * direction with depth > 0, in C.
struct Ray {
  /// Direction (a, b, 1) in normalised coordinates. The parameter along the ray is therefore the depth.
  Eigen::Vector3d direction;
  Eigen::Matrix2d by_pixel;  ///< Derivative of (a, b) with respect to (u, v), 1/px.
};

}  // namespace flexura
