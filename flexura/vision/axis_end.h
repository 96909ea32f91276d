#pragma once

#include <Eigen/Core>
#include <array>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/tube_tracker.h"

namespace flexura {

/// Finds the ends of the centerline in `seen` and sets seen.ends. At a free end, the silhouette is measured
/// along lines parallel to the centerline. For a tube with half width h, the image of a flat or round end is
/// half an ellipse,
///   reach(y) = x + bulge sqrt(1 - (y/h)^2).
/// The tube's sides, and hence the backbone, end at x. The centerline is extended along its arc to x.
template <typename Value>
void find_ends(const TubeTracker<Value>& tracker, const std::array<TrackEnd, 2>& stops, ArmObservation& seen);

extern template void find_ends(const TubeTracker<std::uint8_t>&, const std::array<TrackEnd, 2>&,
                               ArmObservation&);
extern template void find_ends(const TubeTracker<std::uint16_t>&, const std::array<TrackEnd, 2>&,
                               ArmObservation&);

}  // namespace flexura
