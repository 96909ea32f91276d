#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/kinematics/arm_variables.h"

namespace flexura {

/// Returns the points of an arm that distinguish solutions: five per section, base first, in the base's
/// frame, m.
[[nodiscard]] std::vector<Eigen::Vector3d> backbone_points(const ArmVariables& variables,
                                                           const Eigen::VectorXd& x);

/// Returns the largest distance between corresponding points of two arms, m.
[[nodiscard]] double backbone_distance(const std::vector<Eigen::Vector3d>& a,
                                       const std::vector<Eigen::Vector3d>& b);

/// Rotates the arm about its base's z until its first bent section bends towards x.
void turn_to_x(const ArmVariables& variables, Eigen::VectorXd& x);

/// Returns true if `a` comes before `b` in a list of solutions with the preferences `objective_a` and
/// `objective_b`. The smaller preference comes first. If they are equal up to rounding, as for mirror images,
/// the first variable that differs decides, the larger first.
[[nodiscard]] bool comes_first(double objective_a, const Eigen::VectorXd& a, double objective_b,
                               const Eigen::VectorXd& b);

}  // namespace flexura
