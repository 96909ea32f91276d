#pragma once

#include <Eigen/Core>
#include <string>

namespace flexura {

/// A contact of the arm with an obstacle or with itself.
struct PlantContact {
  double s_rest = 0;  ///< Point of the arm: arc length from the arm's base at rest, m.
  std::string with;   ///< Name of the obstacle, or "the arm".
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< Contact point in the world frame, m.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< Force on the arm at the contact point, N.
  double depth = 0;                                 ///< Penetration depth, m.
  double normal_force = 0;                          ///< Force normal to the surface, N.
  bool sticks = false;  ///< Whether the contact sticks, which means that it does not slide.
  /// Whether the arm's centerline is inside the obstacle. If the centerline is inside, the direction of the
  /// force is not meaningful.
  bool is_deep = false;
};

}  // namespace flexura
