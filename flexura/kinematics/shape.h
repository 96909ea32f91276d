#pragma once

#include <string>
#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/arm_config.h"

namespace flexura {

/// Returns the angle of the straight arm (the base's z axis) from +X in the XOY plane, counter-clockwise,
/// rad: the paper's alpha_Ox^0 of eq. 5. Of angles that differ by whole turns, the one nearest to
/// Arm::near_tangent.
[[nodiscard]] double base_tangent_angle(const Arm& arm);

/// Returns the state of `arm` for `shape`; omitted values are straight and unstretched. Throws
/// std::invalid_argument if `shape` does not fit the arm (check_shape).
[[nodiscard]] ArmState arm_state(const Arm& arm, const ShapeConfig& shape);

/// Reports to `reader` the sections that `shape` at `path`, which fits the arm, bends by more than
/// largest_bend. A table's range cannot check this for cord angles and for bends in two directions.
void check_bends(const Arm& arm, const ShapeConfig& shape, const std::string& path, Reader& reader);

/// Returns each section's arching of a planar arm, rad, counter-clockwise.
[[nodiscard]] std::vector<double> archings(const ArmState& state);

/// Returns the angle of each section's cord from +X of a planar arm, rad, counter-clockwise.
[[nodiscard]] std::vector<double> cord_angles(const Arm& arm, const ArmState& state);

}  // namespace flexura
