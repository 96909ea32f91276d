#pragma once

#include <Eigen/Core>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"

// Proofs that an arm cannot reach a target (docs/inverse-kinematics.md, "What is proven"). The proofs use
// only lengths, stretch limits and largest bends of the sections, without any search. All points and
// directions are in the base's frame B. Each lower bound holds for every state within the limits; a bound of
// 0 proves nothing.
namespace flexura {

/// Returns a lower bound on the distance of the tip from `p_BP`, m.
[[nodiscard]] double least_distance(const Arm& arm, const Eigen::Vector3d& p_BP);

/// Returns a lower bound on the angle between the tip's z axis and the unit vector `d_B`, rad.
[[nodiscard]] double least_angle(const Arm& arm, const Eigen::Vector3d& d_B);

/// Returns a lower bound on the rotation angle between the tip's frame and `R_BT`, rad.
[[nodiscard]] double least_angle(const Arm& arm, const Eigen::Matrix3d& R_BT);

/// Returns a lower bound, m, on the distance of the tip from the origin of `X_BT`, for a tip that points
/// along the z axis of `X_BT`. This function applies least_distance() from both ends of the arm.
[[nodiscard]] double least_distance_along(const Arm& arm, const Pose& X_BT);

}  // namespace flexura
