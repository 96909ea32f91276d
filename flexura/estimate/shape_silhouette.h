#pragma once

#include <cstddef>
#include <span>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Returns the view error of a shape's observation `observation`; zero if it is not estimated.
[[nodiscard]] ViewError error_of(const Shape& shape, std::size_t observation);

/// Returns the part of a shape's image without observation: mean square of the distances, each bounded, px^2.
/// It is summed over the pictures with more than an axis (Sighting::borders).
[[nodiscard]] double silhouette_misfit(std::span<const Observation> observations, const Shape& shape);

/// Returns the misfit: how much of the foreground (Sighting::figure) is not the shape's image, as the mean
/// square of its points' distances, each bounded, px^2. The image is widened by the factor `wider`. Invisible
/// parts of the shape do not count: they may be hidden. 0 if no foreground is known, or the arm has no
/// radius.
[[nodiscard]] double misfit(const Observation& seen, const ViewError& error, const Shape& shape,
                            double wider = 1);
/// Returns the sum over the pictures.
[[nodiscard]] double misfit(std::span<const Observation> observations, const Shape& shape);

/// Returns whether most borders of an observation are the shape's, and the shape is inside them.
[[nodiscard]] bool explains_border(const Observation& seen, const ViewError& error, const Shape& shape);

}  // namespace flexura
