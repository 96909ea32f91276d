#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "flexura/control/distributed_arm.h"

// Drives for a few numbers of an arm (docs/control.md, "Finitely many drives").
namespace flexura {

/// Returns G of drives that turn a section as a whole: size() rows, 2 columns per section and then one for
/// each variable length. Column 2k is a constant torque on theta along section k, 2k + 1 that on q (N m per
/// length), for all sections. Then come the forces (N) that change variable lengths. Their coordinates are y
/// = G^T x: the integrals of the angles over a section.
[[nodiscard]] Eigen::MatrixXd section_torques(const DistributedArm& arm);

/// Returns G of drives that bend. Column 2k is the moment (N m) on the change of theta from section k's base
/// to its end, 2k + 1 that of q; then come the lengths' forces. Tendons that end with section k and count
/// from its base act like this. y = G^T x: the turns of the sections (without a clamped base's angles).
[[nodiscard]] Eigen::MatrixXd section_moments(const DistributedArm& arm);

/// Drives that produce a law's forces.
enum class DriveKind : std::uint8_t {
  everywhere,  ///< Each point of the arm is driven independently.
  torques,     ///< section_torques.
  moments,     ///< section_moments.
};
/// Returns G of drives of this kind; empty if everything is driven.
[[nodiscard]] Eigen::MatrixXd drives_of(const DistributedArm& arm, DriveKind kind);

}  // namespace flexura
