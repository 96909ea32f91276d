#pragma once

#include <cstddef>
#include <span>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Returns the error of the view of observation number `observation` in a shape; zero if the error is not
/// estimated.
[[nodiscard]] ViewError error_of(const Shape& shape, std::size_t observation);

/// Returns how much of the shape's image was not observed: the mean square distance of the image's points
/// from observations, each limited to a bound, px^2. Sums over the pictures that have borders
/// (Observation::borders).
[[nodiscard]] double silhouette_misfit(std::span<const Observation> observations, const Shape& shape);

/// Returns how much of the foreground (Observation::figure) is outside the shape's image: the mean square
/// distance of the foreground's points from the image, each limited to a bound, px^2. The shape's image is
/// widened by the factor `wider`. Parts of the shape without foreground do not count, because they may be
/// hidden. The result is 0 if no foreground is known, or if the arm has no radius.
[[nodiscard]] double misfit(const Observation& seen, const ViewError& error, const Shape& shape,
                            double wider = 1);
/// Returns the sum of the misfits of all pictures.
[[nodiscard]] double misfit(std::span<const Observation> observations, const Shape& shape);

/// Returns whether the shape explains the borders of an observation. This requires that most borders are on
/// the shape's image, and that nearly all of the image was observed.
[[nodiscard]] bool explains_border(const Observation& seen, const ViewError& error, const Shape& shape);

}  // namespace flexura
