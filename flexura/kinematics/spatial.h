#pragma once

#include <cstddef>
#include <span>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Forward kinematics without allocation: `frames` (one more than the sections, else std::invalid_argument)
/// receives each section's base frame X_WS and, last, the tip X_WT. `state` must fit the arm, here and below;
/// std::invalid_argument otherwise.
void section_frames(const Arm& arm, const ArmState& state, std::span<Pose> frames);

/// X_WT alone.
[[nodiscard]] Pose tip_pose(const Arm& arm, const ArmState& state);

/// A point that stays with the arm's material however it stretches.
struct MaterialPoint {
  std::size_t section = 0;  ///< 0 at the base.
  double fraction = 0.0;    ///< Of the section's length, in [0, 1].
};

/// The material point that lies `s` m from the base when the arm is not stretched, s in [0, arm.length()]
/// (past an end by rounding is at that end; std::out_of_range further out). Where two sections meet it is the
/// end of the first.
[[nodiscard]] MaterialPoint material_point(const Arm& arm, double s);

/// Where a material point lies on the arm as stretched: arc length for Backbone::pose, m.
[[nodiscard]] double arc_length_of(const Arm& arm, const ArmState& state, const MaterialPoint& point);

}  // namespace flexura
