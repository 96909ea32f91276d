#pragma once

#include <Eigen/Core>

namespace flexura {

/// The end of an arc in the frame at its start, and how it moves with the arc's bend.
struct ArcMotion {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d position;             ///< m.
  Eigen::Matrix<double, 3, 2> linear;   ///< Velocity of the end per unit rate of bend_x, bend_y, m/rad.
  Eigen::Matrix<double, 3, 2> angular;  ///< Its angular velocity, the same way.
};

/// arc_pose (model/backbone.h) and its derivatives in one go: one sine and cosine for all of it, none for
/// bends under half a radian. For solvers, which ask for little else; to a few units in the last place of the
/// arc's length. `bend` in rad, `length` in m.
[[nodiscard]] ArcMotion arc_motion(const Eigen::Vector2d& bend, double length);

}  // namespace flexura
