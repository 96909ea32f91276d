#pragma once

#include <string>
#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/arm_config.h"

namespace flexura {

/// Angle of the straight arm (the base's z axis) from +X in the XOY plane, counter-clockwise, rad: the
/// paper's alpha_Ox^0 of eq. 5. Of those that differ by whole turns, the one nearest to Arm::near_tangent.
[[nodiscard]] double base_tangent_angle(const Arm& arm);

/// The state of `arm` that `shape` means; what is left out is straight and unstretched. `shape` fits the arm
/// (check_shape); std::invalid_argument otherwise.
[[nodiscard]] ArmState arm_state(const Arm& arm, const ShapeConfig& shape);

/// Reports to `reader` the sections that `shape` at `path`, which fits the arm, bends by more than
/// largest_bend: what no range of a table can say of cord angles and of bends in two directions.
void check_bends(const Arm& arm, const ShapeConfig& shape, const std::string& path, Reader& reader);

/// Each section's arching of a planar arm, rad, counter-clockwise.
[[nodiscard]] std::vector<double> archings(const ArmState& state);

/// Each section's cord's angle from +X of a planar arm, rad, counter-clockwise.
[[nodiscard]] std::vector<double> cord_angles(const Arm& arm, const ArmState& state);

}  // namespace flexura
