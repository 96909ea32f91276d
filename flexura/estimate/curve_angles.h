#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flexura/estimate/observation.h"
#include "flexura/model/backbone.h"

namespace flexura {

/// The two continuous angles, rad, of a backbone's direction in W,
///   e = (sin azimuth cos elevation, cos azimuth cos elevation, sin elevation).
/// Both angles are zero where the arm points along +Y. The azimuth is positive towards +X, and the elevation
/// towards +Z.
struct DirectionAngles {
  double azimuth = 0;    ///< Angle towards +X, rad, continuous along the arm.
  double elevation = 0;  ///< Angle towards +Z, rad, from -pi/2 to pi/2.
  /// Whether the paper's method is ill-conditioned here: the azimuth differs by less than 10 degrees from 90
  /// degrees. The error of the elevation is tan(azimuth) times the error of the azimuth.
  bool is_singular = false;
};

/// Returns the angles of a backbone at `count` points (at least 2), evenly spaced along its length.
[[nodiscard]] std::vector<DirectionAngles> direction_angles(const Backbone& backbone, std::size_t count);

/// Returns the direction from the angles of the curve's images in the planes XOY and ZOY, from Y towards X
/// and towards Z. For parallel projections azimuth = alpha_1, tan elevation = tan alpha_2 cos alpha_1.
[[nodiscard]] DirectionAngles angles_of_planes(double alpha_1, double alpha_2);

/// Returns the angles from two pictures by the paper's method, at `count` points evenly spaced along the arm.
/// The method assumes that each image is a parallel projection along the camera's axis. `front` looks roughly
/// along Z, and `side` roughly along X. Corresponding points are found by correspondence(). The result is
/// empty if the pictures have fewer than 8 points in common. With a real perspective camera, the error is
/// several degrees (docs/estimation.md).
[[nodiscard]] std::vector<DirectionAngles> plane_angles(const Observation& front, const Observation& side,
                                                        std::size_t count);

}  // namespace flexura
