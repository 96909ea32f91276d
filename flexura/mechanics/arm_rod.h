#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/statics.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_config.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/drive.h"
#include "flexura/model/drive_config.h"

namespace flexura {

/// Returns the elastic rod of an arm described by a file, in the frame of the arm's base. The rod has the
/// tendons of `[[arm.tendon]]`. If there are none, the rod has the tendons of `drive`, and the drive's disks
/// in sections without disks of their own. Throws std::invalid_argument if a section has no material; other
/// keys were checked by the file's reader.
[[nodiscard]] Rod rod_of(const ArmConfig& arm, const std::optional<DriveConfig>& drive);
/// Returns the rod of an arm without a drive.
[[nodiscard]] Rod rod_of(const ArmConfig& arm);

/// Returns gravity and the loads of `[[arm.load]]`, turned from the world into the frame of the arm's base.
/// Loads that follow the end of their section stay in its frame.
[[nodiscard]] RodLoads loads_of(const ArmConfig& arm);

/// Returns how far each tendon of a rod is pulled in, m, if the rod's sections are arcs, bent and stretched
/// as in `state`. Simulated arms use this function to convert commanded bends into displacements. The
/// pulled-in length increases with the bend even if the bend is so large that a tendon would pass the arc's
/// centre. Real rods cannot bend so far. Throws std::invalid_argument if `state` has another number of
/// sections.
[[nodiscard]] TendonDisplacements arc_displacements(const Rod& rod, const ArmState& state);
/// Returns the derivatives of arc_displacements with respect to the (bend_x, bend_y, stretch) of each
/// section. There is one row per tendon and 3 columns per section. Throws as arc_displacements.
[[nodiscard]] Eigen::MatrixXd arc_displacement_slopes(const Rod& rod, const ArmState& state);

/// Returns how far a rod's tendons are pulled in, m, if each pulls with `tension` N without other loads.
/// Throws std::invalid_argument if the rod has no equilibrium.
[[nodiscard]] std::vector<double> pretension_displacements(RodStatics& statics, double tension);

/// Default number of arcs of a section of an arm that is modelled as a rod.
inline constexpr std::size_t arcs_of_rod_section = 3;

/// Returns the model of an arm and its drive that tasks use. In this model, a section consists of one or
/// several arcs (Section::bend_profile). If the arm's model is static or dynamic, the shape for a command is
/// the shape of the rod's equilibrium (RodResponse). Throws as RodResponse.
[[nodiscard]] ArmModel arm_model_of(const ArmConfig& arm, const std::optional<DriveConfig>& drive);

}  // namespace flexura
