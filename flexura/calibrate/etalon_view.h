#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "flexura/base/image.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/vision/etalon_finder.h"

namespace flexura {

/// Pose of a camera relative to the calibration cylinder, from one picture (docs/calibration-paper.md, "What
/// a picture of the cylinder tells"). Angles in rad, lengths in the radius's unit.
struct EtalonView {
  std::string reason;                       ///< Why nothing below is known, or only `centroid`; "" if all is.
  std::optional<Eigen::Vector2d> centroid;  ///< Centroid of the visible part of the dark figure, px.
  bool is_too_large = false;                ///< Whether it touches opposite borders.
  EtalonObservation observation;

  double middle = 0;         ///< Middle of the silhouette, right of the principal point, px.
  double line = 0;           ///< Nearest red line, right of the silhouette's middle, px.
  double height = 0;         ///< Middle of the silhouette, below the principal point, px.
  double taper = 0;          ///< Upper width minus lower width, px.
  double width = 0;          ///< Width in the middle, px.
  double sight = 0;          ///< Optical axis, to the left of the line of sight to the cylinder's axis.
  double bearing = 0;        ///< Camera direction around the cylinder, to the right of the red line.
  double drop = 0;           ///< Line of sight, below the optical axis.
  double climb = 0;          ///< Height of the camera above the middle's level, as an angle.
  double distance = 0;       ///< Distance from the cylinder's axis.
  double magnification = 0;  ///< Focal length over distance.
  double roll = 0;           ///< Roll of the camera, clockwise seen from behind it.
  double bearing_by_px = 0;  ///< d bearing / d line.
  double climb_by_px = 0;    ///< d climb / d taper.
};

/// Returns the centroid of the visible part of the largest dark figure; empty without a figure.
[[nodiscard]] std::optional<Eigen::Vector2d> dark_centroid(const Image<std::uint8_t>& picture);

/// Evaluates a picture of a cylinder of this radius with the lens model.
[[nodiscard]] EtalonView view_etalon(const Image<std::uint8_t>& picture, const Intrinsics& intrinsics,
                                     double radius);

}  // namespace flexura
