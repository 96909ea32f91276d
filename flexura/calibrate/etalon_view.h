#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "flexura/base/image.h"
#include "flexura/camera/intrinsics.h"
#include "flexura/vision/etalon_finder.h"

namespace flexura {

/// How a camera stands to the calibration cylinder, by one picture (docs/calibration-paper.md, "What a
/// picture of the cylinder tells"). Angles in rad, lengths in the radius's unit.
struct EtalonView {
  std::string reason;  ///< Why nothing below is known, or only `centroid`; "" when all is.
  std::optional<Eigen::Vector2d> centroid;  ///< Of the dark figure, as far as it is in the picture, px.
  bool is_too_large = false;                ///< It touches opposite borders.
  EtalonSighting sighting;

  double middle = 0;         ///< Of the silhouette, right of the principal point, px.
  double line = 0;           ///< The nearest red line, right of the silhouette's middle, px.
  double height = 0;         ///< The silhouette's middle, below the principal point, px.
  double taper = 0;          ///< Its width above less that below, px.
  double width = 0;          ///< In its middle, px.
  double sight = 0;          ///< The optical axis, to the left of the line of sight to the cylinder's axis.
  double bearing = 0;        ///< Where the camera stands around the cylinder, to the right of the red line.
  double drop = 0;           ///< The line of sight, below the optical axis.
  double climb = 0;          ///< How far above the middle's level it stands, as an angle.
  double distance = 0;       ///< From the cylinder's axis.
  double magnification = 0;  ///< Focal length over distance.
  double roll = 0;           ///< Of the camera, clockwise seen from behind it.
  double bearing_by_px = 0;  ///< d bearing / d line.
  double climb_by_px = 0;    ///< d climb / d taper.
};

/// The middle of the largest dark figure's pixels, as far as it is in the picture; none where there is none.
[[nodiscard]] std::optional<Eigen::Vector2d> dark_centroid(const Image<std::uint8_t>& picture);

/// What the picture tells of a cylinder of this radius, by a lens as it is believed to be.
[[nodiscard]] EtalonView view_etalon(const Image<std::uint8_t>& picture, const Intrinsics& intrinsics,
                                     double radius);

}  // namespace flexura
