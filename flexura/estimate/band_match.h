#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_problem.h"
#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Identifies the observed bands as markers, by their order along `shape`, which is accurate to `sigma` m. If
/// that is less than the distance between markers, bands are matched with each other, or with the prior's
/// markers, by position and colour. Bands without a counterpart are omitted: false detections, or bands
/// hidden in a picture. Otherwise bands are counted, if all observations have equally many. Empty if no match
/// is possible. Markers seen only once are omitted unless their position is known.
[[nodiscard]] std::vector<BandObservation> match_bands(const ShapePrior& prior, const Shape& shape,
                                                       double sigma,
                                                       std::span<const Observation> observations);

/// A marker on a shape.
struct PlacedMarker {
  double s = 0;                        ///< Observed arc length, m; the mean over its observations.
  std::size_t observation_counts = 0;  ///< Number of observations of the marker.
};

/// Returns the positions of the matched markers on `shape`, from its base on.
[[nodiscard]] std::vector<PlacedMarker> placed_markers(const ShapePrior& prior, const Shape& shape,
                                                       std::span<const BandObservation> observation_counts,
                                                       std::span<const Observation> observations);

}  // namespace flexura
