#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_layout.h"
#include "flexura/mechanics/rod_surroundings.h"

namespace flexura {

/// Places of a rod between its nodes, whose motion is that of a part of their interval: the rod's own,
/// without interpolation. They belong to a layout, and are looked at only where something may pull at them.
struct RodPoints {
  struct Point {
    std::size_t section = 0;
    std::size_t interval = 0;  ///< Of its section.
    std::size_t node = 0;      ///< Of all nodes: where the interval begins; or where the point is.
    double part = 0;           ///< Of the interval, by arc length at rest.
    bool is_node = false;
    std::size_t first_moment = 0;
  };

  /// std::invalid_argument: a place outside the rod.
  RodPoints(const Rod& rod, const RodLayout& layout, std::span<const RodPlace> places);

  std::vector<Point> points;
  /// Of each point that is no node: the three moments of each of its section's modes from its interval's
  /// beginning on, and after them of the six strains at rest, but for what stretches the rod at rest.
  std::vector<double> moments;
};

}  // namespace flexura
