#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "flexura/control/distributed_arm.h"

// Finitely many drives of a distributed arm (docs/control.md, "Finitely many drives").
namespace flexura {

/// Returns the matrix G of drives that apply a uniform torque along each section. The matrix has size() rows.
/// G has 2 columns per section, and then one column for each variable length. Column 2k is a constant torque
/// on theta along section k, and column 2k + 1 a constant torque on q (N m per length). The columns of
/// variable lengths are the forces (N) that change these lengths. The coordinates of the drives are y = G^T
/// x: the integrals of the angles over each section.
[[nodiscard]] Eigen::MatrixXd section_torques(const DistributedArm& arm);

/// Returns the matrix G of drives that bend sections. Column 2k is the moment (N m) on the change of theta
/// from section k's base to its end. Column 2k + 1 is the moment on the change of q. The last columns are the
/// forces on variable lengths. Tendons that end at section k act in this way if their lengths are measured
/// from the section's base. The coordinates of the drives are y = G^T x: the changes of the angles along each
/// section, without the angles of a clamped base.
[[nodiscard]] Eigen::MatrixXd section_moments(const DistributedArm& arm);

/// Kind of drives that produce a law's forces.
enum class DriveKind : std::uint8_t {
  everywhere,  ///< An independent drive at each point of the arm.
  torques,     ///< The drives of section_torques().
  moments,     ///< The drives of section_moments().
};
/// Returns the matrix G of drives of this kind; empty if each point is driven.
[[nodiscard]] Eigen::MatrixXd drives_of(const DistributedArm& arm, DriveKind kind);

}  // namespace flexura
