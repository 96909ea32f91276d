#pragma once

#include <cstddef>
#include <span>

#include "flexura/math/pose.h"
#include "flexura/model/arm.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// Computes forward kinematics without memory allocation. Writes the base frame X_WS of each section and then
/// the tip frame X_WT to `frames`. Throws std::invalid_argument unless `frames` has one element more than the
/// arm has sections. All functions in this file also throw std::invalid_argument unless `state` has one bend
/// and one stretch per section.
void section_frames(const Arm& arm, const ArmState& state, std::span<Pose> frames);

/// Returns the tip frame X_WT.
[[nodiscard]] Pose tip_pose(const Arm& arm, const ArmState& state);

/// A point of the arm's material, which moves with stretch.
struct MaterialPoint {
  std::size_t section = 0;  ///< Index of the section with the point; 0 at the base.
  double fraction = 0.0;    ///< Position along the section as a fraction of its length, in [0, 1].
};

/// Returns the material point at arc length s, m, from the base of the unstretched arm, s in [0,
/// arm.length()]. Where two sections meet, the point is the end of the first section. Values that are beyond
/// an end because of rounding are clamped to the end. Throws std::out_of_range for values further outside.
[[nodiscard]] MaterialPoint material_point(const Arm& arm, double s);

/// Returns the arc length of a material point on the stretched arm, m, as used by Backbone::pose().
[[nodiscard]] double arc_length_of(const Arm& arm, const ArmState& state, const MaterialPoint& point);

}  // namespace flexura
