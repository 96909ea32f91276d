#pragma once

#include <cstddef>
#include <span>

#include "flexura/estimate/shape_variables.h"
#include "flexura/estimate/sighting.h"

namespace flexura {

/// What is wrong with the view of a shape's sighting `sighting`; nothing where that is not told.
[[nodiscard]] ViewError error_of(const Shape& shape, std::size_t sighting);

/// How much of a shape's image lies where nothing is seen: mean square of the distances, bounded for each,
/// px^2; summed over the pictures that show more than an axis (Sighting::borders).
[[nodiscard]] double astray(std::span<const Sighting> sightings, const Shape& shape);

/// How much of the figure (Sighting::figure) is no image of the shape: mean square of its places' distances
/// from that, bounded for each, px^2. The image counts as `wider` times as wide. What is not seen of the
/// shape does not count: something may hide it. 0 where no figure is known, or the arm has no radius.
[[nodiscard]] double misfit(const Sighting& seen, const ViewError& error, const Shape& shape,
                            double wider = 1);
/// The sum over the pictures.
[[nodiscard]] double misfit(std::span<const Sighting> sightings, const Shape& shape);

/// Whether the borders of a sighting are the shape's, most of them, and the shape is seen within them.
[[nodiscard]] bool explains_border(const Sighting& seen, const ViewError& error, const Shape& shape);

}  // namespace flexura
