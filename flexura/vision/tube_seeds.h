#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"

namespace flexura {

/// A point in a component, and the shortest chord through it.
struct TubeSeed {
  Eigen::Vector2d center = {0, 0};  ///< The chord's middle, px.
  Eigen::Vector2d normal = {1, 0};  ///< Unit vector along the chord.
  double width = 0;                 ///< Length of the chord, px.
};

/// Returns the shortest chord through a pixel of the component over `directions` evenly spaced directions. If
/// all chords are longer than `limit` px, the returned width is above the limit.
[[nodiscard]] TubeSeed shortest_chord(const Components& components, const Eigen::Vector2d& from, double limit,
                                      int directions = 16);

/// Finds chords through points spread over a component, those of medium width first. Where tubes cross or
/// end, or under a hair, chords are longer or shorter than elsewhere.
void tube_seeds(const Components& components, const Component& component, std::vector<TubeSeed>& seeds);

}  // namespace flexura
