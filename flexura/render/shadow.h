#pragma once

#include <Eigen/Core>
#include <array>

#include "flexura/render/stage.h"

namespace flexura {

/// Adds the shadow of a straight tube whose ends are both flat or both round; none if the scene's light casts
/// none.
void add_caster(const Arc& tube, TipKind ends, const Pose& X_CW, Stage& stage);
/// And of a box around the origin of X_CB.
void add_caster(const Pose& X_CB, const std::array<double, 3>& half_sizes, Stage& stage);

/// The share of the directional light that shadows leave at a point of a surface on the light's side: those
/// of the arm, and of everything else that casts one if `of_all`.
[[nodiscard]] double shadow_at(const Stage& stage, const Eigen::Vector3d& p_CQ, bool of_all);

}  // namespace flexura
