#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Returns a shape roughly along points in space, base first: each section bends from the curve's tangent at
/// its start to that at its end. The prior's knowledge of the base is kept. Throws std::invalid_argument
/// without two different points.
[[nodiscard]] Shape shape_along(const ShapePrior& prior, std::span<const Eigen::Vector3d> points);

/// Returns `shape` with the part after the start of a section mirrored in the plane through that point
/// perpendicular to the line of sight. What `view` shows stays about the same, unlike in other views.
[[nodiscard]] Shape mirrored(const ShapePrior& prior, const Shape& shape, std::size_t section,
                             const View& view);

/// Returns `ways` shapes with another bend of one section, `bend` rad in evenly spaced directions. For parts
/// that are hidden or seen end-on, whose direction no picture shows at first.
[[nodiscard]] std::vector<Shape> bent_otherwise(const Shape& shape, std::size_t section, double bend,
                                                int ways);

/// Returns the prior's arm, straight.
[[nodiscard]] Shape straight_shape(const ShapePrior& prior);

}  // namespace flexura
