#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Returns a shape roughly along points in space, in order from the base. Each section bends from the curve's
/// tangent at the section's start to the tangent at its end. A base that the prior knows is kept. Throws
/// std::invalid_argument unless two points differ.
[[nodiscard]] Shape shape_along(const ShapePrior& prior, std::span<const Eigen::Vector3d> points);

/// Returns `shape` with its part beyond a section's start mirrored. The mirror plane passes through that
/// start, perpendicular to the line of sight. The image in `view` hardly changes, but the images in other
/// views do.
[[nodiscard]] Shape mirrored(const ShapePrior& prior, const Shape& shape, std::size_t section,
                             const View& view);

/// Returns `ways` shapes in which one section bends by `bend` rad, in evenly spaced directions. They are
/// starts for a section that is hidden or seen end-on, so that no picture shows its direction.
[[nodiscard]] std::vector<Shape> bent_otherwise(const Shape& shape, std::size_t section, double bend,
                                                int ways);

/// Returns the prior's arm in its straight shape.
[[nodiscard]] Shape straight_shape(const ShapePrior& prior);

}  // namespace flexura
