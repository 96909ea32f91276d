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

/// An angle moved by whole turns to within half a turn of another one, rad.
[[nodiscard]] double nearest_turn(double angle, double other);

}  // namespace flexura
