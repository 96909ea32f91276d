#pragma once

#include <Eigen/Core>

namespace flexura {

/// Pose of an arc's end frame in the arc's start frame, and its derivatives with respect to the bend.
struct ArcMotion {
  Eigen::Matrix3d rotation;
  Eigen::Vector3d position;  ///< Position, m.
  Eigen::Matrix<double, 3, 2>
      linear;  ///< Derivative of the position with respect to bend_x and bend_y, m/rad.
  Eigen::Matrix<double, 3, 2>
      angular;  ///< Angular velocity of the end frame per unit rate of bend_x and bend_y.
};

/// Returns arc_pose() (model/backbone.h) and its derivatives, for a bend in rad and a length in m. A fast
/// version for solvers: the function computes only one sine and one cosine, and no sine or cosine for bends
/// below 0.5 rad. Errors are a few units in the last place of the length.
[[nodiscard]] ArcMotion arc_motion(const Eigen::Vector2d& bend, double length);

}  // namespace flexura
