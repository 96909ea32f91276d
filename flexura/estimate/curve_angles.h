#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/estimate/sighting.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// The two continuous angles of a backbone's direction in W,
///   e = (sin azimuth cos elevation, cos azimuth cos elevation, sin elevation), rad:
/// both zero where the arm runs along +Y, azimuth positive towards +X, elevation towards +Z.
struct DirectionAngles {
  double azimuth = 0;    ///< Continuous along the arm.
  double elevation = 0;  ///< From -pi/2 to pi/2.
  /// The paper's reading says little here: of an error of the azimuth, the elevation takes tan(azimuth) times
  /// as much, and the azimuth is within 10 degrees of 90.
  bool is_singular = false;
};

/// Of a backbone, at `count` (at least 2) equal shares of its length.
[[nodiscard]] std::vector<DirectionAngles> direction_angles(const Backbone& backbone, std::size_t count);

/// From the angles of the curve's images in the planes XOY and ZOY, from Y towards X and towards Z, read as
/// parallel projections: azimuth = alpha_1, tan elevation = tan alpha_2 cos alpha_1.
[[nodiscard]] DirectionAngles angles_of_planes(double alpha_1, double alpha_2);

/// The paper's reading of two pictures, at `count` equal shares of the arm's length: each image's direction
/// is taken for that of a parallel projection along its camera's axis. `front` looks along Z, `side` along X,
/// roughly. Points are paired as correspondence() does. Empty when the pictures have fewer than 8 points in
/// common. With real perspective it is off by degrees (docs/estimation.md).
[[nodiscard]] std::vector<DirectionAngles> plane_angles(const Sighting& front, const Sighting& side,
                                                        std::size_t count);

}  // namespace flexura
