#pragma once

#include <Eigen/Core>

namespace flexura {

/// The paper's two angles of a direction in W, rad: azimuth and elevation, with
///   e = (sin azimuth cos elevation, cos azimuth cos elevation, sin elevation):
/// both zero along +Y, azimuth positive towards +X, elevation towards +Z.
/// Of a direction of any length but 0: the azimuth from -pi to pi, the elevation from -pi/2 to pi/2. Along Z
/// any azimuth is right, and one of them is given.
[[nodiscard]] Eigen::Vector2d angles_of_direction(const Eigen::Vector3d& e);
/// The unit vector of W with these angles.
[[nodiscard]] Eigen::Vector3d direction_of_angles(const Eigen::Vector2d& angles);

/// What two parallel views show of a direction is the angle alpha_1 from Y towards X in the plane XOY, which
/// is its azimuth, and alpha_2 from Y towards Z in the plane ZOY. Its elevation by them, rad (paper, section
/// 2): atan(tan alpha_2 cos alpha_1).
[[nodiscard]] double elevation_of_planes(double alpha_1, double alpha_2);
/// Whether the azimuth is within 10 degrees of a quarter turn, where alpha_2 says little of the elevation.
[[nodiscard]] bool is_singular_for_planes(double azimuth);

/// An angle moved by whole turns to within half a turn of another one, rad.
[[nodiscard]] double nearest_turn(double angle, double other);

}  // namespace flexura
