#pragma once

#include <cstddef>
#include <span>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Computes forward kinematics without allocation. `frames` receives each section's base frame X_WS and,
/// last, the tip X_WT. Throws std::invalid_argument unless `frames` has one more element than there are
/// sections. Here and below, throws std::invalid_argument if `state` does not fit the arm.
void section_frames(const Arm& arm, const ArmState& state, std::span<Pose> frames);

/// Returns X_WT.
[[nodiscard]] Pose tip_pose(const Arm& arm, const ArmState& state);

/// A point of the arm's material, which moves with stretch.
struct MaterialPoint {
  std::size_t section = 0;  ///< 0 at the base.
  double fraction = 0.0;    ///< Share of the section's length, in [0, 1].
};

/// Returns the material point at `s` m from the base of the unstretched arm, s in [0, arm.length()]. Where
/// two sections meet it is the end of the first. Values past an end by rounding count as that end. Throws
/// std::out_of_range for values further out.
[[nodiscard]] MaterialPoint material_point(const Arm& arm, double s);

/// Returns the arc length of a material point on the stretched arm, for Backbone::pose, m.
[[nodiscard]] double arc_length_of(const Arm& arm, const ArmState& state, const MaterialPoint& point);

}  // namespace flexura
