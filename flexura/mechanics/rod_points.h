#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_layout.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// Places of a rod between its nodes. Their motion is that of the end of a partial interval, without
/// interpolation. They belong to a RodLayout and are evaluated only where a wrench may act.
struct RodPoints {
  struct Point {
    std::size_t section = 0;   ///< Index of its element.
    std::size_t interval = 0;  ///< Index in its element.
    /// Index among all nodes: that of the interval's beginning, or of the point itself if it is a node.
    std::size_t node = 0;
    double part = 0;  ///< Part of the interval, by undeformed arc length.
    bool is_node = false;
    std::size_t first_moment = 0;
  };

  /// Throws std::invalid_argument for a place outside the rod.
  RodPoints(const RodLayout& layout, std::span<const RodPlace> places);

  std::vector<Point> points;
  /// Moments for each point that is not a node, from its interval's beginning on. First come the three
  /// moments of each of its element's modes, then those of the six undeformed strains, without driven
  /// stretch.
  std::vector<double> moments;
};

}  // namespace flexura
