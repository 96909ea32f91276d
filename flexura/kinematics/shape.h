#pragma once

#include <string>
#include <vector>

#include "flexura/model/arm.h"
#include "flexura/model/arm_config.h"

namespace flexura {

/// Returns the angle of the straight arm (the base's z axis) from +X in the XOY plane, counter-clockwise,
/// rad: the paper's alpha_Ox^0 in eq. 5. Among angles that differ by full turns, returns the angle nearest to
/// Arm::near_tangent.
[[nodiscard]] double base_tangent_angle(const Arm& arm);

/// Returns the state of `arm` that `shape` describes. Omitted bends are 0, and omitted stretches are 1.
/// Throws std::invalid_argument for a shape with errors that check_shape() would report.
[[nodiscard]] ArmState arm_state(const Arm& arm, const ShapeConfig& shape);

/// Reports to `reader` sections that bend by more than largest_bend. The shape must have no errors of
/// check_shape(). `path`: path of the shape in the document. Ranges of fields cannot check this for chord
/// angles and for bends in two directions.
void check_bends(const Arm& arm, const ShapeConfig& shape, const std::string& path, Reader& reader);

/// Returns the arching of each section of a planar arm, counter-clockwise, rad.
[[nodiscard]] std::vector<double> archings(const ArmState& state);

/// Returns the angle of each section's chord from +X for a planar arm, counter-clockwise, rad.
[[nodiscard]] std::vector<double> cord_angles(const Arm& arm, const ArmState& state);

}  // namespace flexura
