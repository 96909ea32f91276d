#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_problem.h"
#include "flexura/estimate/shape_variables.h"

namespace flexura {

/// Identifies the observed bands as markers, by their order along `shape`. `sigma`: standard deviation of the
/// shape, m. If `sigma` is smaller than the distance between markers, matches bands by position and colour
/// with the bands of other observations, or with the markers of the prior. Omits bands without a counterpart,
/// which are false detections or are hidden in another picture. If `sigma` is larger, and all observations
/// show equally many bands, matches bands by their index. The result is empty if no match is possible. The
/// result omits markers with an unknown position that were observed only once.
[[nodiscard]] std::vector<BandObservation> match_bands(const ShapePrior& prior, const Shape& shape,
                                                       double sigma,
                                                       std::span<const Observation> observations);

/// A marker on a shape.
struct PlacedMarker {
  double s = 0;           ///< Observed arc length, m; the mean over its observations.
  std::size_t count = 0;  ///< Number of observations of the marker.
};

/// Returns the positions of the matched markers on `shape`, from base to tip.
[[nodiscard]] std::vector<PlacedMarker> placed_markers(const ShapePrior& prior, const Shape& shape,
                                                       std::span<const BandObservation> bands,
                                                       std::span<const Observation> observations);

}  // namespace flexura
