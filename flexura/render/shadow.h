#pragma once

#include <Eigen/Core>
#include <array>

#include "flexura/render/stage.h"

namespace flexura {

/// Adds a straight tube that casts a shadow, if the scene has shadows. The tube has two flat or two round
/// ends.
void add_caster(const Arc& tube, TipKind ends, const Pose& X_CW, Stage& stage);
/// Adds a box that casts a shadow. The centre of the box is at the origin of frame B in X_CB.
void add_caster(const Pose& X_CB, const std::array<double, 3>& half_sizes, Stage& stage);

/// Returns the fraction of the directional light that reaches a surface point which faces the light. The arm
/// casts shadows and, if `of_all`, all other bodies too.
[[nodiscard]] double shadow_at(const Stage& stage, const Eigen::Vector3d& p_CQ, bool of_all);

}  // namespace flexura
