#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "flexura/base/image.h"
#include "flexura/vision/runs.h"
#include "flexura/vision/threshold.h"

namespace flexura {

/// The shortest chord through a point of a component.
struct TubeSeed {
  Eigen::Vector2d center = {0, 0};  ///< Middle of the chord, px.
  Eigen::Vector2d normal = {1, 0};  ///< Unit vector along the chord.
  double width = 0;                 ///< Length of the chord, px.
};

/// Returns the shortest chord through a pixel of a component, among `directions` evenly spaced directions. If
/// all chords are longer than `limit`, px, the returned width is above `limit`.
[[nodiscard]] TubeSeed shortest_chord(const Components& components, const Eigen::Vector2d& from, double limit,
                                      int directions = 16);

/// Finds the shortest chords through points that are distributed over a component. Chords of medium length
/// come first. Where tubes cross or end, or where a hair covers the tube, chords have unusual lengths.
void tube_seeds(const Components& components, const Component& component, std::vector<TubeSeed>& seeds);

}  // namespace flexura
