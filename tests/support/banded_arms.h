#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/calibrate/marker_vote.h"
#include "flexura/model/arm.h"

namespace flexura {

/// Red, green, blue.
inline const std::vector<Eigen::Vector3d> band_colors = {
    {0.85, 0.1, 0.1}, {0.1, 0.6, 0.15}, {0.1, 0.2, 0.85}};

/// A dozen bands of three colours in turn, evenly along an arm of 1 m.
inline std::vector<KnownMarker> bands() {
  constexpr std::size_t count = 12;
  std::vector<KnownMarker> markers(count);
  for (std::size_t i = 0; i < count; ++i)
    markers[i] = {.s = (static_cast<double>(i) + 0.5) / count, .color = band_colors[i % band_colors.size()]};
  return markers;
}

/// Of three sections: mild bends, and such as bend every part to every side.
inline std::vector<ArmState> some_poses() {
  std::vector<ArmState> poses(3, ArmState::straight(3));
  poses[0].bends = {{0.5, 0}, {0.5, 0}, {0.5, 0}};
  poses[1].bends = {{0, 0.5}, {0, 0.5}, {0, 0.5}};
  poses[2].bends = {{-0.6, 0.3}, {0.7, 0.1}, {0.5, -0.8}};
  return poses;
}

/// Of rough guesses: 10 degrees, 20 % of the distance, 10 % of the focal length.
inline constexpr PointingPrior rough = {.sideways = 0.26, .roll = 0.17, .scale = 0.22};

}  // namespace flexura
