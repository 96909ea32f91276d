#include "flexura/estimate/axis_beginning.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace flexura {

std::optional<Aside> aside_of_beginning(const Sighting& seen, const Eigen::Vector2d& pixel) {
  constexpr double stretch = 40, before = 15, behind = 5;  // px
  constexpr std::size_t fewest = 6;
  const auto& points = seen.points;
  std::size_t count = 0;
  while (count < points.size() && (points[count].pixel - points[0].pixel).norm() < stretch) ++count;
  if (count < fewest) return std::nullopt;
  const Eigen::Vector2d way = (points[count - 1].pixel - points[0].pixel).normalized();
  const auto along = [&](const Eigen::Vector2d& p) { return way.dot(p - points[0].pixel); };
  const auto across = [&](const Eigen::Vector2d& p) {
    return way.x() * (p - points[0].pixel).y() - way.y() * (p - points[0].pixel).x();
  };
  const double x = along(pixel);
  if (x < -before || x > behind) return std::nullopt;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double sigma = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = along(points[i].pixel);
    const Eigen::Vector3d row(1, at, at * at);
    normal += row * row.transpose(), right += row * across(points[i].pixel);
    sigma = std::max(sigma, points[i].sigma);
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(normal);
  const Eigen::Vector3d curve = solver.solve(right), row(1, x, x * x);
  // Neighbours whose errors go together tell no more than one of them.
  const double spacing = stretch / static_cast<double>(count),
               alike = std::max(1.0, 2 * seen.reach.sigma / spacing);
  return Aside{std::abs(across(pixel) - curve.dot(row)) / std::hypot(1, curve[1] + 2 * curve[2] * x),
               sigma * std::sqrt(alike * row.dot(solver.solve(row)))};
}

}  // namespace flexura
