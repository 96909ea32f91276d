#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace flexura {

// Conversions of arrays, as in files, to vectors and rotations.

/// Converts an array to a vector.
[[nodiscard]] inline Eigen::Vector3d vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }
[[nodiscard]] inline Eigen::Vector4d vector(const std::array<double, 4>& a) {
  return {a[0], a[1], a[2], a[3]};
}

/// Returns an error text if (w, x, y, z) is not a unit quaternion within 1e-3, otherwise "".
[[nodiscard]] std::string quaternion_problem(const std::array<double, 4>& wxyz);

/// Returns the rotation of a quaternion (w, x, y, z) of any length above 0.
[[nodiscard]] Eigen::Matrix3d rotation_of(const std::array<double, 4>& wxyz);

}  // namespace flexura
