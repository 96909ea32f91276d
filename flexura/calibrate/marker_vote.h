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

/// A picture of an arm, and the modelled positions of its markers and ends in W.
struct MarkerPicture {
  struct Place {
    Eigen::Vector3d p_W = {0, 0, 0};  ///< Position in W, m.
    Eigen::Vector3d color = {1, 1, 1};
  };
  View view;  ///< View as modelled.
  std::vector<Place> markers;
  std::array<Eigen::Vector3d, 2> ends;  ///< Base and tip in W, m.
  MarkerScene seen;
};

/// Error of a camera's orientation and focal length, equal in all pictures of the camera. The arm appears
/// rotated about the camera by `turn` (a rotation vector in W, rad), and enlarged by the factor exp(`scale`).
/// For a distant arm, an error of the camera's position has almost the same effect.
struct PointingError {
  Eigen::Vector3d turn = {0, 0, 0};
  double scale = 0;
};

/// Prior standard deviations of a PointingError.
struct PointingPrior {
  /// Standard deviation of rotations about the axes perpendicular to the line of sight, rad.
  double sideways = 0.25;
  double roll = 0.17;  ///< Standard deviation of the rotation about the line of sight, rad.
  double scale = 0.22;
};

/// Returns the scene expected in a picture of a camera with this error.
[[nodiscard]] MarkerScene expected_scene(const MarkerPicture& picture, const PointingError& error);

/// Returns at most `most` errors of one camera that best explain all its pictures together, the best first.
/// Of errors with equal marker identities, returns only the best. If part of the arm is outside the picture,
/// several pictures with different bends are needed: in a single picture, the markers could be matched
/// shifted along the arm. Returns no errors without pictures, and only the error 0 if nothing is visible. All
/// values of `pointing_prior` must be positive.
[[nodiscard]] std::vector<PointingError> likely_errors(std::span<const MarkerPicture> pictures,
                                                       const PointingPrior& pointing_prior, std::size_t most);

}  // namespace flexura
