#include "flexura/math/direction.h"

#include <cmath>
#include <numbers>

namespace flexura {

Eigen::Vector2d angles_of_direction(const Eigen::Vector3d& e) {
  return {std::atan2(e.x(), e.y()), std::atan2(e.z(), std::hypot(e.x(), e.y()))};
}

Eigen::Vector3d direction_of_angles(const Eigen::Vector2d& angles) {
  return {std::sin(angles[0]) * std::cos(angles[1]), std::cos(angles[0]) * std::cos(angles[1]),
          std::sin(angles[1])};
}

double elevation_of_planes(double alpha_1, double alpha_2) {
  return std::atan(std::tan(alpha_2) * std::cos(alpha_1));
}

bool is_singular_for_planes(double azimuth) {
  constexpr double least_cosine = 0.17364817766693033;  // cos 80 degrees.
  return std::abs(std::cos(azimuth)) < least_cosine;
}

double nearest_turn(double angle, double other) {
  return angle + 2 * std::numbers::pi * std::round((other - angle) / (2 * std::numbers::pi));
}

}  // namespace flexura
