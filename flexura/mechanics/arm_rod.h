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

/// The elastic rod of an arm as a file describes it, in the frame of the arm's base, with the tendons of
/// `[[arm.tendon]]`; where there are none, with those of `drive` if there is one, and its disks in sections
/// that name none of their own. std::invalid_argument: a section has no material; the rest is as the file's
/// reader has checked it.
[[nodiscard]] Rod rod_of(const ArmConfig& arm, const std::optional<DriveConfig>& drive);
/// The same of an arm without a drive.
[[nodiscard]] Rod rod_of(const ArmConfig& arm);

/// Gravity and the loads of `[[arm.load]]`, turned from the world into the frame of the arm's base. Loads
/// that follow the end of their section stay in its frame.
[[nodiscard]] RodLoads loads_of(const ArmConfig& arm);

/// How far each tendon of a rod is pulled in, m, when its sections are arcs bent and stretched as `state`
/// says: what is believed of an arm whose tendons are pulled to bend it so. A bend whose middle a tendon
/// would pass, which no rod makes, pulls it in by more the stronger it is. std::invalid_argument: a state of
/// another number of sections.
[[nodiscard]] TendonDisplacements arc_displacements(const Rod& rod, const ArmState& state);
/// Their derivative by every section's (bend_x, bend_y, stretch): one row a tendon, 3 columns a section.
/// Errors likewise.
[[nodiscard]] Eigen::MatrixXd arc_displacement_slopes(const Rod& rod, const ArmState& state);

/// How far a rod's tendons are pulled in, m, when each pulls with `tension` N and nothing else does.
/// std::invalid_argument: the rod comes to no rest.
[[nodiscard]] std::vector<double> pretension_displacements(RodStatics& statics, double tension);

/// Arcs of a section of an arm that is believed to be a rod, where its file says no other number.
inline constexpr std::size_t arcs_of_rod_section = 3;

/// An arm and its drive as tasks believe them to be: a section is an arc, or several (Section::bend_profile);
/// of an arm whose model is static or dynamic, what its rod at rest makes of commands (RodResponse). Errors
/// as RodResponse.
[[nodiscard]] ArmModel arm_model_of(const ArmConfig& arm, const std::optional<DriveConfig>& drive);

}  // namespace flexura
