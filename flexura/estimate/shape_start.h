#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// A shape that lies roughly along points in space, base first: each section bends from the curve's tangent
/// at its start to that at its end. What the prior knows of the base stays. At least two points, not all the
/// same, else std::invalid_argument.
[[nodiscard]] Shape shape_along(const ShapePrior& prior, std::span<const Eigen::Vector3d> points);

/// `shape` with all that follows the start of a section mirrored in the plane through that across the line of
/// sight: what `view` shows stays about the same, and what others show does not.
[[nodiscard]] Shape mirrored(const ShapePrior& prior, const Shape& shape, std::size_t section,
                             const View& view);

/// `shape` with one section bent otherwise, `ways` of them around by so much, rad: for parts that are hidden
/// or seen end on, of which no picture tells at first where they go.
[[nodiscard]] std::vector<Shape> bent_otherwise(const Shape& shape, std::size_t section, double bend,
                                                int ways);

/// The prior's arm, straight.
[[nodiscard]] Shape straight_shape(const ShapePrior& prior);

}  // namespace flexura
