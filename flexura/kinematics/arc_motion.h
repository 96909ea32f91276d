#pragma once

#include <Eigen/Core>

namespace flexura {

/// End of an arc in the frame at its start, and its derivatives by the arc's bend.
struct ArcMotion {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d position;             ///< In m.
  Eigen::Matrix<double, 3, 2> linear;   ///< Velocity of the end per unit rate of bend_x, bend_y, m/rad.
  Eigen::Matrix<double, 3, 2> angular;  ///< Angular velocity of the end per unit rate of bend_x, bend_y.
};

/// Returns arc_pose (model/backbone.h) and its derivatives. Needs only one sine and cosine, and none for
/// bends under half a radian. For solvers, which need little else. Precise to a few units in the last place
/// of the arc's length. `bend` in rad, `length` in m.
[[nodiscard]] ArcMotion arc_motion(const Eigen::Vector2d& bend, double length);

}  // namespace flexura
