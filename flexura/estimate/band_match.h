#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/shape_problem.h"
#include "flexura/estimate/shape_variables.h"
#include "flexura/estimate/sighting.h"

namespace flexura {

/// Which of the bands in the sightings are which markers, by their order along `shape`, which is nearly
/// right: to `sigma` m. Where that is less than what lies between two markers, bands are brought together, or
/// with the prior's markers, by their places and colours, and what has no counterpart is left out: false
/// ones, ones that are hidden in a picture. Otherwise by counting, where all sightings have as many. Empty
/// when nothing can be said. Looks at one marker alone are left out unless its place is known.
[[nodiscard]] std::vector<BandLook> match_bands(const ShapePrior& prior, const Shape& shape, double sigma,
                                                std::span<const Sighting> sightings);

/// A marker on a shape.
struct PlacedMarker {
  double s = 0;           ///< m of arc length, where it is seen; the mean of its looks.
  std::size_t looks = 0;  ///< How many sightings see it.
};

/// Where the markers that were matched lie on `shape`, from its base on.
[[nodiscard]] std::vector<PlacedMarker> placed_markers(const ShapePrior& prior, const Shape& shape,
                                                       std::span<const BandLook> looks,
                                                       std::span<const Sighting> sightings);

}  // namespace flexura
