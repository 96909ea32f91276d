#pragma once

#include <Eigen/Core>
#include <array>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/tube_tracker.h"

namespace flexura {

/// Finds the ends of the axis of `seen` and fills them in. At a free end the silhouette is measured along
/// lines beside the axis. Over the tube's half width h, the image of a flat or round end is half an ellipse,
///   reach(y) = x + bulge sqrt(1 - (y/h)^2).
/// The sides, and hence the backbone, end at x. The axis is extended along its arc to there.
template <typename Value>
void find_ends(const TubeTracker<Value>& tracker, const std::array<TrackEnd, 2>& stops, ArmObservation& seen);

extern template void find_ends(const TubeTracker<std::uint8_t>&, const std::array<TrackEnd, 2>&,
                               ArmObservation&);
extern template void find_ends(const TubeTracker<std::uint16_t>&, const std::array<TrackEnd, 2>&,
                               ArmObservation&);

}  // namespace flexura
