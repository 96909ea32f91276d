#pragma once

#include <optional>

#include "flexura/mechanics/rod.h"
#include "flexura/model/arm.h"
#include "flexura/model/arm_config.h"
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
/// says: what is believed of an arm whose tendons are pulled to bend it so. std::invalid_argument: a state of
/// another number of sections.
[[nodiscard]] TendonDisplacements arc_displacements(const Rod& rod, const ArmState& state);

}  // namespace flexura
