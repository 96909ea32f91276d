#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/kinematics/arm_variables.h"

namespace flexura {

/// Returns points of the backbone with which solutions are compared: five points per section, from base to
/// tip, in the base's frame, m.
[[nodiscard]] std::vector<Eigen::Vector3d> backbone_points(const ArmVariables& variables,
                                                           const Eigen::VectorXd& x);

/// Returns the largest distance between corresponding points of two backbones, m.
[[nodiscard]] double backbone_distance(const std::vector<Eigen::Vector3d>& a,
                                       const std::vector<Eigen::Vector3d>& b);

/// Rotates the arm about its base's z axis so that the first bent section bends towards the base's x.
void turn_to_x(const ArmVariables& variables, Eigen::VectorXd& x);

/// Returns whether solution `a` is listed before solution `b`. The solution with the smaller value of the
/// objective is first. If the values are equal up to rounding, as for mirror images, the first variable that
/// differs decides: the solution with the larger value is first.
[[nodiscard]] bool comes_first(double objective_a, const Eigen::VectorXd& a, double objective_b,
                               const Eigen::VectorXd& b);

}  // namespace flexura
