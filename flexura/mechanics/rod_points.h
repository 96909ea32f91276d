#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_layout.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// Places of a rod between its nodes. The motion of a place is computed exactly, as the motion of the end of
/// a partial interval. The places belong to a RodLayout, and are evaluated only if a wrench may act there.
struct RodPoints {
  struct Point {
    std::size_t section = 0;   ///< Index of the element that contains the place.
    std::size_t interval = 0;  ///< Index of the interval in this element.
    /// Index among all nodes of the interval's beginning, or of the point itself if the point is a node.
    std::size_t node = 0;
    double part = 0;  ///< Position in the interval, as a fraction of the undeformed arc length.
    bool is_node = false;
    std::size_t first_moment = 0;
  };

  /// Throws std::invalid_argument for a place outside the rod.
  RodPoints(const RodLayout& layout, std::span<const RodPlace> places);

  std::vector<Point> points;
  /// Moments of the partial interval of each point that is not a node. First come the three moments of each
  /// mode of its element, then the moments of the six undeformed strains, without driven stretch.
  std::vector<double> moments;
};

}  // namespace flexura
