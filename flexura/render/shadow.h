#pragma once

#include <Eigen/Core>
#include <array>

#include "flexura/render/stage.h"

namespace flexura {

/// Adds the shadow of a straight tube with two flat or two round ends, if the scene's light casts shadows.
void add_caster(const Arc& tube, TipKind ends, const Pose& X_CW, Stage& stage);
/// Adds the shadow of a box around the origin of X_CB.
void add_caster(const Pose& X_CB, const std::array<double, 3>& half_sizes, Stage& stage);

/// Returns the share of the directional light left by shadows at a surface point on the light's side. Counts
/// shadows of the arm, and of all other casters if `of_all`.
[[nodiscard]] double shadow_at(const Stage& stage, const Eigen::Vector3d& p_CQ, bool of_all);

}  // namespace flexura
