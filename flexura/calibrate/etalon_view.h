#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "flexura/base/image.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/vision/etalon_finder.h"

namespace flexura {

/// Pose of a camera relative to the calibration cylinder, measured in one picture (docs/calibration-paper.md,
/// "What a picture of the cylinder shows"). Angles are in rad, lengths in the unit of the radius.
struct EtalonView {
  std::string
      /// Why the following members are unknown, or "" if they are known. `centroid` and `is_too_large` may be
      /// known in any case.
      reason;
  std::optional<Eigen::Vector2d> centroid;  ///< Centroid of the visible part of the dark figure, px.
  bool is_too_large = false;  ///< Whether the dark figure touches opposite borders of the picture.
  EtalonObservation observation;

  double middle = 0;  ///< Distance of the silhouette's middle from the principal point, to the right, px.
  double line = 0;    ///< Distance of the nearest red line from the silhouette's middle, to the right, px.
  double height = 0;  ///< Distance of the silhouette's middle from the principal point, downwards, px.
  double taper = 0;   ///< Width at the top minus width at the bottom of the silhouette, px.
  double width = 0;   ///< Width of the silhouette in its middle, px.
  double sight = 0;   ///< Angle of the optical axis to the left of the line of sight to the cylinder's axis.
  /// Angle around the cylinder from the red line to the camera's direction, to the right.
  double bearing = 0;
  double drop = 0;           ///< Angle of the line of sight below the optical axis.
  double climb = 0;          ///< Elevation of the camera above the level of the cylinder's middle.
  double distance = 0;       ///< Distance of the camera from the cylinder's axis.
  double magnification = 0;  ///< Focal length divided by the distance.
  double roll = 0;           ///< Roll of the camera, clockwise seen from behind the camera.
  double bearing_by_px = 0;  ///< Derivative d bearing / d line, rad/px.
  double climb_by_px = 0;    ///< Derivative d climb / d taper, rad/px.
};

/// Returns the centroid of the visible part of the largest dark figure, px; empty without a figure.
[[nodiscard]] std::optional<Eigen::Vector2d> dark_centroid(const Image<std::uint8_t>& picture);

/// Measures the image of the calibration cylinder in a picture and computes the camera's pose relative to it.
/// `radius`: radius of the cylinder.
[[nodiscard]] EtalonView view_etalon(const Image<std::uint8_t>& picture, const Intrinsics& intrinsics,
                                     double radius);

}  // namespace flexura
