#include "flexura/kinematics/planar.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "flexura/math/series.h"

namespace flexura {

std::vector<double> cord_angles_from_archings(std::span<const double> archings, double base_tangent) {
  std::vector<double> cord_angles;
  cord_angles.reserve(archings.size());
  double tangent = base_tangent;
  for (const double arching : archings) {
    cord_angles.push_back(tangent + arching);
    tangent += 2.0 * arching;
  }
  return cord_angles;
}

std::vector<double> archings_from_cord_angles(std::span<const double> cord_angles, double base_tangent) {
  std::vector<double> archings;
  archings.reserve(cord_angles.size());
  double tangent = base_tangent;
  for (const double cord_angle : cord_angles) {
    archings.push_back(cord_angle - tangent);
    tangent += 2.0 * archings.back();
  }
  return archings;
}

// 0 - x, not -x: a straight section's bend and arching are 0, never -0.
Eigen::Vector2d bend_from_arching(double arching) { return {0.0 - 2.0 * arching, 0.0}; }

double arching_from_bend(const Eigen::Vector2d& bend) {
  if (bend.y() != 0.0) {
    throw std::invalid_argument("a planar section's bend_y must be 0, not " + std::to_string(bend.y()));
  }
  return 0.0 - 0.5 * bend.x();
}

std::vector<Eigen::Vector2d> base_points(std::span<const double> lengths, std::span<const double> archings,
                                         const Eigen::Vector2d& base_point, double base_tangent) {
  if (lengths.size() != archings.size()) {
    throw std::invalid_argument(std::to_string(lengths.size()) + " section lengths do not match " +
                                std::to_string(archings.size()) + " archings");
  }
  std::vector<Eigen::Vector2d> points;
  points.reserve(lengths.size() + 1);
  points.push_back(base_point);
  double tangent = base_tangent;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const double cord_angle = tangent + archings[i];
    const double cord = lengths[i] * sinc(archings[i]);  // Eq. 6; negative beyond a full circle.
    points.emplace_back(points.back() + cord * Eigen::Vector2d(std::cos(cord_angle), std::sin(cord_angle)));
    tangent += 2.0 * archings[i];
  }
  return points;
}

}  // namespace flexura
