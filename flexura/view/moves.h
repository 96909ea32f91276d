#pragma once

#include <string>
#include <vector>

#include "flexura/camera/camera.h"
#include "flexura/kinematics/inverse.h"
#include "flexura/model/arm_model.h"
#include "flexura/model/backbone.h"
#include "flexura/model/drive.h"
#include "flexura/model/obstacle.h"
#include "flexura/sim/tendon_pull.h"
#include "flexura/view/request.h"

// Checks and conversions of requested arm moves. All functions are pure and callable from any thread.
namespace flexura {

/// Returns the shape that a client requests, clamped to the arm's limits. Throws ViewRefusal with the reason
/// if the request does not fit the arm.
[[nodiscard]] ArmState requested_shape(const Arm& arm, const std::optional<Drive>& drive,
                                       const ArmRequest& request);
[[nodiscard]] ArmState requested_shape(const Arm& arm, const ShapeConfig& shape);

/// Displacements of tendons that are pulled individually.
struct TendonPull {
  std::vector<double> displacements;  ///< Displacement of each tendon, m.
};
/// Returns the displacements that a client requests for a rig's actuators. Throws ViewRefusal if the number
/// of displacements is wrong, or if a displacement is out of range.
[[nodiscard]] TendonPull requested_pull(const std::vector<PulledTendon>& actuators,
                                        const std::vector<double>& displacements);

/// Throws ViewRefusal if the camera has no stage, or if the stage cannot move along a requested axis.
void require_travel(const Camera& camera, const StageRequest& request);

/// Returns the shape within the sections' limits that is nearest to `state`.
[[nodiscard]] ArmState within_limits(const Arm& arm, ArmState state);

/// Returns a command that reaches the requested tip pose, or comes nearest to it. The search starts at `from`
/// and is fast enough to follow a user who drags the tip.
[[nodiscard]] InverseResult shape_for_tip(const ArmModel& arm, const ArmState& from,
                                          const TipRequest& request);

/// Returns in one line why the arm must not move on a straight path from one command to another; "" if it
/// may. Ignores violations that already exist at the start and do not worsen.
[[nodiscard]] std::string danger_on_path(const ArmModel& arm, const std::vector<Obstacle>& obstacles,
                                         const ArmState& from, const ArmState& to);

/// Returns in one line which section violates its bend or stretch limit, or "".
[[nodiscard]] std::string beyond_limits(const Arm& arm, const ArmState& state);

/// Returns in one line what an arm with this backbone touches, or "".
[[nodiscard]] std::string touched(const Backbone& backbone, const std::vector<Obstacle>& obstacles);

}  // namespace flexura
