#pragma once

#include <Eigen/Core>
#include <string>

namespace flexura {

/// Where an arm touches something.
struct PlantContact {
  double s_rest = 0;  ///< Place on the arm: arc length from its base at rest, m.
  std::string with;   ///< The obstacle's name, or "the arm".
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< In the world, m.
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< On the arm there, N.
  double depth = 0;                                 ///< m
  double normal_force = 0;                          ///< Across the surface, N.
  bool sticks = false;                              ///< It does not slide along the other.
  bool is_deep = false;  ///< The arm's middle is inside: the force may push anywhere.
};

}  // namespace flexura
