#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "flexura/control/distributed_arm.h"

// Drives for a few numbers of an arm (docs/control.md, "Finitely many drives").
namespace flexura {

/// G, size() rows, 2 columns a section and then one for each length that varies: drives that turn a section
/// as a whole. Column 2k is the torque on theta alike along section k, 2k + 1 that on q (N m a length), all
/// sections; then the forces (N) that change their lengths, where these vary. Its own numbers are y = G^T x:
/// the integrals of the angles over a section.
[[nodiscard]] Eigen::MatrixXd section_torques(const DistributedArm& arm);

/// G of drives that bend: column 2k is the moment (N m) on the change of theta from section k's base to its
/// end, 2k + 1 that of q; then the lengths' forces. Tendons that end with section k and are counted from its
/// base pull so. y = G^T x: what the sections turn by (a clamped base's own angles left out).
[[nodiscard]] Eigen::MatrixXd section_moments(const DistributedArm& arm);

/// What gives an arm a law's forces.
enum class DriveKind : std::uint8_t {
  everywhere,  ///< Each point of the arm is driven by itself.
  torques,     ///< section_torques
  moments,     ///< section_moments
};
/// G of drives of this kind; empty where everything is driven.
[[nodiscard]] Eigen::MatrixXd drives_of(const DistributedArm& arm, DriveKind kind);

}  // namespace flexura
