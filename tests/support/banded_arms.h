#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/calibrate/marker_vote.h"
#include "flexura/model/arm.h"

namespace flexura {

/// RGB colours of the bands.
inline const std::vector<Eigen::Vector3d> band_colors = {
    {0.85, 0.1, 0.1}, {0.1, 0.6, 0.15}, {0.1, 0.2, 0.85}};

/// Returns a dozen bands at equal spacing along an arm of 1 m, in three alternating colours.
inline std::vector<KnownMarker> bands() {
  constexpr std::size_t count = 12;
  std::vector<KnownMarker> markers(count);
  for (std::size_t i = 0; i < count; ++i)
    markers[i] = {.s = (static_cast<double>(i) + 0.5) / count, .color = band_colors[i % band_colors.size()]};
  return markers;
}

/// Returns poses of a three-section arm: mild bends, and bends that turn every part to every side.
inline std::vector<ArmState> some_poses() {
  std::vector<ArmState> poses(3, ArmState::straight(3));
  poses[0].bends = {{0.5, 0}, {0.5, 0}, {0.5, 0}};
  poses[1].bends = {{0, 0.5}, {0, 0.5}, {0, 0.5}};
  poses[2].bends = {{-0.6, 0.3}, {0.7, 0.1}, {0.5, -0.8}};
  return poses;
}

/// Camera prior for rough guesses: 10 degrees of rotation, 20 % of the distance, 10 % of the focal length.
inline constexpr PointingPrior rough = {.sideways = 0.26, .roll = 0.17, .scale = 0.22};

}  // namespace flexura
