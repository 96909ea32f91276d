#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "flexura/calibrate/marker_match.h"
#include "flexura/camera/view.h"

namespace flexura {

/// A picture of an arm, and where the arm's markers and ends are believed to be in W.
struct MarkerPicture {
  struct Place {
    Eigen::Vector3d p_W = {0, 0, 0};  ///< m
    Eigen::Vector3d color = {1, 1, 1};
  };
  View view;  ///< As believed.
  std::vector<Place> markers;
  std::array<Eigen::Vector3d, 2> ends;  ///< Base and tip, m.
  MarkerScene seen;
};

/// What is wrong with where a camera looks and with how long its lens is, the same in all its pictures: the
/// arm is seen turned about the camera by `turn` (a rotation vector in W, rad), and larger by exp(`scale`). A
/// camera that stands elsewhere shows an arm far away much as if it looked elsewhere and had another lens.
struct SightError {
  Eigen::Vector3d turn = {0, 0, 0};
  double scale = 0;
};

/// Standard deviations of that.
struct SightDoubt {
  double sideways = 0.25;  ///< Of turns that shift a picture, rad.
  double roll = 0.17;      ///< Of turns about the line of sight, rad.
  double scale = 0.22;
};

/// What is expected in a picture of a camera that is wrong like this.
[[nodiscard]] MarkerScene expected_scene(const MarkerPicture& picture, const SightError& error);

/// The errors of one camera that explain most of what is seen in all of its pictures together, the best one
/// first, `most` at most; those that take the same for the same count once. Of one picture alone a chain of
/// markers that leaves it may be taken for the same shifted along the arm; arms bent in other ways would have
/// to be shifted elsewhere. None without pictures; no error where nothing is seen. Doubts are above 0.
[[nodiscard]] std::vector<SightError> likely_errors(std::span<const MarkerPicture> pictures,
                                                    const SightDoubt& doubt, std::size_t most);

}  // namespace flexura
