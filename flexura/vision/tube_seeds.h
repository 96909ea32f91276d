#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"

namespace flexura {

/// A place in a component, and the shortest chord through it.
struct TubeSeed {
  Eigen::Vector2d center = {0, 0};  ///< The chord's middle, px.
  Eigen::Vector2d normal = {1, 0};  ///< Along the chord.
  double width = 0;                 ///< px
};

/// The shortest of the chords through a pixel of the figure that are no longer than `limit` px, of so many
/// evenly spread directions; none is (width above the limit) when there is none.
[[nodiscard]] TubeSeed shortest_chord(const Components& components, const Eigen::Vector2d& from, double limit,
                                      int directions = 16);

/// Chords through places evenly over a component, those of middling width first: where tubes cross, or end,
/// or a hair lies over them, chords are longer or shorter than elsewhere.
void tube_seeds(const Components& components, const Component& component, std::vector<TubeSeed>& seeds);

}  // namespace flexura
