#pragma once

#include <Eigen/Core>
#include <vector>

#include "flexura/kinematics/arm_variables.h"

namespace flexura {

/// The points of an arm by which solutions are told apart: five of each section, base first, in the base's
/// frame, m.
[[nodiscard]] std::vector<Eigen::Vector3d> backbone_points(const ArmVariables& variables,
                                                           const Eigen::VectorXd& x);

/// The largest distance between two arms at the same place of the same section, m.
[[nodiscard]] double backbone_distance(const std::vector<Eigen::Vector3d>& a,
                                       const std::vector<Eigen::Vector3d>& b);

/// Turns the arm about its base's z until its first section that is bent bends towards x.
void turn_to_x(const ArmVariables& variables, Eigen::VectorXd& x);

/// Whether `a` comes before `b` in a list of solutions with the wishes `wish_a` and `wish_b`: the smaller
/// wish first; where they are the same but for rounding, as of mirror images, by the first variable that
/// differs, the larger first.
[[nodiscard]] bool comes_first(double wish_a, const Eigen::VectorXd& a, double wish_b,
                               const Eigen::VectorXd& b);

}  // namespace flexura
