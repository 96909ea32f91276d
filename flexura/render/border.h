#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>

#include "flexura/render/ray.h"

namespace flexura {

/// Borders are reported up to this distance from a ray, px.
inline constexpr double border_reach = 3;

/// A border near a point of the image: a curve across which the visible surface or its colour changes. The
/// curve is approximated by a straight line.
struct Border {
  double distance = std::numeric_limits<double>::infinity();  ///< Distance from the point, px; >= 0.
  Eigen::Vector2d towards = {1, 0};                           ///< Unit vector from the point to the line.
  double depth = 0;                                           ///< Depth of the border in space, m.
  bool is_ring = false;  ///< Whether the border is the edge of a coloured ring on the arm.

  bool operator<(const Border& other) const { return distance < other.distance; }
};

/// Returns the border at which a function of the image is zero. `value`: value of the function at the ray.
/// `by_direction`: derivative of the function with respect to the ray's (a, b). The result is exact to first
/// order.
[[nodiscard]] inline Border border_of(double value, const Eigen::Vector2d& by_direction, const Ray& ray,
                                      double depth) {
  const Eigen::Vector2d by_pixel = ray.by_pixel.transpose() * by_direction;
  const double slope = by_pixel.norm();
  Border border;
  border.depth = depth;
  if (!(slope > 0)) return border;
  border.distance = std::abs(value) / slope;
  border.towards = by_pixel * ((value > 0 ? -1 : 1) / slope);
  return border;
}

}  // namespace flexura
