#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_problem.h"
#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Identifies the observed bands as markers, by their order along `shape`, which is accurate to `sigma` m. If
/// `sigma` is less than the distance between markers, bands are matched by position and colour. The match is
/// with the bands of other observations, or with the markers of the prior. Bands without a counterpart are
/// omitted: they are false detections, or are hidden in a picture. If `sigma` is larger, bands are matched by
/// their number in order, if each observation shows equally many. Empty if no match is possible. Markers seen
/// only once are omitted unless their position is known.
[[nodiscard]] std::vector<BandObservation> match_bands(const ShapePrior& prior, const Shape& shape,
                                                       double sigma,
                                                       std::span<const Observation> observations);

/// A marker on a shape.
struct PlacedMarker {
  double s = 0;           ///< Observed arc length, m; the mean over its observations.
  std::size_t count = 0;  ///< Number of observations of the marker.
};

/// Returns the positions of the matched markers on `shape`, from its base on.
[[nodiscard]] std::vector<PlacedMarker> placed_markers(const ShapePrior& prior, const Shape& shape,
                                                       std::span<const BandObservation> bands,
                                                       std::span<const Observation> observations);

}  // namespace flexura
