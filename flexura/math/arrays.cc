#include "flexura/math/arrays.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

namespace flexura {

std::string quaternion_problem(const std::array<double, 4>& wxyz) {
  constexpr double tolerance = 1e-3;
  const double norm = vector(wxyz).norm();
  if (std::abs(norm - 1) <= tolerance) return "";
  return fmt::format("has the norm {:.6g}: expected a unit quaternion (w, x, y, z)", norm);
}

Eigen::Matrix3d rotation_of(const std::array<double, 4>& wxyz) {
  return Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]).normalized().toRotationMatrix();
}

}  // namespace flexura
