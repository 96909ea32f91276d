#pragma once

#include <Eigen/Core>
#include <array>

#include "flexura/vision/arm_finder.h"
#include "flexura/vision/tube_tracker.h"

namespace flexura {

/// Finds where the axis of `seen` ends and fills its ends. At a free end the silhouette is looked at along
/// lines beside the axis: over the tube's width h the image of a flat end is half an ellipse,
///   reach(y) = x + bulge sqrt(1 - (y/h)^2),
/// and so is that of a round one; x is where the sides end, which is where the backbone does. The axis is
/// carried on along its arc to there.
template <typename Value>
void find_ends(const TubeTracker<Value>& tracker, const std::array<TrackEnd, 2>& stops, ArmSighting& seen);

extern template void find_ends(const TubeTracker<std::uint8_t>&, const std::array<TrackEnd, 2>&,
                               ArmSighting&);
extern template void find_ends(const TubeTracker<std::uint16_t>&, const std::array<TrackEnd, 2>&,
                               ArmSighting&);

}  // namespace flexura
