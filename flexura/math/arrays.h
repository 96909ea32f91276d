#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

namespace flexura {

// Arrays of a file's numbers as what they stand for.

/// The same numbers in the same order.
[[nodiscard]] inline Eigen::Vector3d vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }
[[nodiscard]] inline Eigen::Vector4d vector(const std::array<double, 4>& a) {
  return {a[0], a[1], a[2], a[3]};
}

/// What keeps (w, x, y, z) from being a unit quaternion, as people write one, to 1e-3; "" when nothing does.
[[nodiscard]] std::string quaternion_problem(const std::array<double, 4>& wxyz);

/// The rotation of a quaternion (w, x, y, z) of any length above 0.
[[nodiscard]] Eigen::Matrix3d rotation_of(const std::array<double, 4>& wxyz);

}  // namespace flexura
