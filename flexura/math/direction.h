#pragma once

#include <Eigen/Core>

namespace flexura {

/// Returns the paper's two angles of a direction in W, rad: azimuth and elevation, with
///   e = (sin azimuth cos elevation, cos azimuth cos elevation, sin elevation).
/// Both are zero along +Y; the azimuth is positive towards +X, the elevation towards +Z. The direction may
/// have any length except 0. The azimuth is in [-pi, pi], the elevation in [-pi/2, pi/2]. Along Z the azimuth
/// is arbitrary.
[[nodiscard]] Eigen::Vector2d angles_of_direction(const Eigen::Vector3d& e);
/// Returns the unit vector in W with these angles.
[[nodiscard]] Eigen::Vector3d direction_of_angles(const Eigen::Vector2d& angles);

/// Returns the elevation of a direction from two parallel views, rad: atan(tan alpha_2 cos alpha_1) (paper,
/// section 2). The azimuth alpha_1 is the angle from Y towards X in the plane XOY. The angle alpha_2 is from
/// Y towards Z in the plane ZOY.
[[nodiscard]] double elevation_of_planes(double alpha_1, double alpha_2);
/// Returns true if the azimuth is within 10 degrees of a quarter turn, where alpha_2 gives little information
/// on the elevation.
[[nodiscard]] bool is_singular_for_planes(double azimuth);

/// Returns an angle moved by whole turns to within half a turn of another one, rad.
[[nodiscard]] double nearest_turn(double angle, double other);

}  // namespace flexura
