#pragma once

#include <Eigen/Core>

namespace flexura {

/// Returns the paper's two angles of a direction e in W, azimuth and elevation, rad:
///   e = (sin azimuth cos elevation, cos azimuth cos elevation, sin elevation).
/// Both angles are zero along +Y; the azimuth is positive towards +X, the elevation towards +Z. e may have
/// any length above 0. The azimuth is in [-pi, pi], the elevation in [-pi/2, pi/2]. For directions along Z
/// the azimuth is arbitrary.
[[nodiscard]] Eigen::Vector2d angles_of_direction(const Eigen::Vector3d& e);
/// Returns the unit vector in W with the given azimuth and elevation, rad.
[[nodiscard]] Eigen::Vector3d direction_of_angles(const Eigen::Vector2d& angles);

/// Returns the elevation of a direction, rad, from its angles in two parallel projections. The result is
/// atan(tan alpha_2 cos alpha_1) (paper, section 2). The azimuth alpha_1, rad, is the angle from Y towards X
/// in the plane XOY. The angle alpha_2, rad, is from Y towards Z in the plane ZOY.
[[nodiscard]] double elevation_of_planes(double alpha_1, double alpha_2);
/// Returns whether the azimuth, rad, is within 10 degrees of +-90 degrees. At such azimuths, the angle in the
/// plane ZOY contains little information about the elevation.
[[nodiscard]] bool is_singular_for_planes(double azimuth);

/// Returns `angle` plus the multiple of 2 pi for which the result is nearest to `other`, rad.
[[nodiscard]] double nearest_turn(double angle, double other);

}  // namespace flexura
