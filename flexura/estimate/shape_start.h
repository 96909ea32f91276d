#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Returns a shape roughly along points in space, in order from the base. Each section bends from the curve's
/// tangent at the section's start to the tangent at its end. If the prior knows the base, the shape has this
/// base. Throws std::invalid_argument unless two points differ.
[[nodiscard]] Shape shape_along(const ShapePrior& prior, std::span<const Eigen::Vector3d> points);

/// Returns `shape` with the part beyond the start of a section mirrored. The mirror plane contains the
/// section's start and is perpendicular to the line of sight. The image in `view` hardly changes, but the
/// images in other views do.
[[nodiscard]] Shape mirrored(const ShapePrior& prior, const Shape& shape, std::size_t section,
                             const View& view);

/// Returns `ways` shapes in which one section bends by `bend` rad, in evenly spaced directions. The shapes
/// are starting points for a section whose direction no picture shows, because it is hidden or points at the
/// camera.
[[nodiscard]] std::vector<Shape> bent_otherwise(const Shape& shape, std::size_t section, double bend,
                                                int ways);

/// Returns the prior's arm in its straight shape.
[[nodiscard]] Shape straight_shape(const ShapePrior& prior);

}  // namespace flexura
