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

// What becomes of wishes where the arm shall go: pure functions, which other threads call.
namespace flexura {

/// The shape that a client asks for, drawn to the arm's limits. Throws a ViewRefusal when it is none of this
/// arm, with the reason.
[[nodiscard]] ArmState shape_wanted(const Arm& arm, const std::optional<Drive>& drive,
                                    const ArmRequest& request);
[[nodiscard]] ArmState shape_wanted(const Arm& arm, const ShapeConfig& shape);

/// Tendons that are pulled in one by one.
struct TendonPull {
  std::vector<double> displacements;  ///< m
};
/// What a client asks of a rig's actuators; a ViewRefusal where these are not as many, or one is beyond its
/// range.
[[nodiscard]] TendonPull pull_wanted(const std::vector<PulledTendon>& actuators,
                                     const std::vector<double>& displacements);

/// A ViewRefusal where the camera has no stage, or one that does not move along what is asked for.
void require_travel(const Camera& camera, const StageRequest& request);

/// The shape nearest to `state` within the sections' limits.
[[nodiscard]] ArmState within_limits(const Arm& arm, ArmState state);

/// A command for the tip, near the one from which it is sought: quick enough to follow a hand.
[[nodiscard]] InverseResult shape_for_tip(const ArmModel& arm, const ArmState& from,
                                          const TipRequest& request);

/// Why the arm must not go straight from one command to another, one line; "" when nothing is in the way.
/// What is wrong already at the start, and gets no worse, is no reason to stay.
[[nodiscard]] std::string danger_on_way(const ArmModel& arm, const std::vector<Obstacle>& obstacles,
                                        const ArmState& from, const ArmState& to);

/// Which section is bent or stretched beyond its limits, one line; "" when none.
[[nodiscard]] std::string beyond_limits(const Arm& arm, const ArmState& state);

/// What an arm touches that lies so, one line; "" when nothing.
[[nodiscard]] std::string touched(const Backbone& backbone, const std::vector<Obstacle>& obstacles);

}  // namespace flexura
