#include "flexura/estimate/axis_beginning.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "flexura/math/small_cholesky.h"

namespace flexura {

std::optional<Aside> aside_of_beginning(const Observation& seen, const Eigen::Vector2d& pixel) {
  constexpr double stretch = 40, before = 15, behind = 5;  // px
  constexpr std::size_t fewest = 8;
  const auto& points = seen.points;
  std::size_t count = 1;
  double length = 0;
  for (; count < points.size() && (length < stretch || count < fewest); ++count)
    length += (points[count].pixel - points[count - 1].pixel).norm();
  if (count < fewest || length < stretch) return std::nullopt;
  const auto step = [&](std::size_t i) { return (points[i].pixel - points[i - 1].pixel).normalized(); };
  // The cosine of half a radian: the image of a stronger bend is no parabola.
  constexpr double straight = 0.88;
  for (std::size_t i = 2; i < count; ++i)
    if (step(i).dot(step(1)) < straight) return std::nullopt;
  const Eigen::Vector2d way = (points[count - 1].pixel - points[0].pixel).normalized();
  const auto along = [&](const Eigen::Vector2d& p) { return way.dot(p - points[0].pixel); };
  const auto across = [&](const Eigen::Vector2d& p) {
    return way.x() * (p - points[0].pixel).y() - way.y() * (p - points[0].pixel).x();
  };
  const double x = along(pixel);
  if (x < -before || x > behind) return std::nullopt;
  const auto row_at = [](double at) { return Eigen::Vector3d(1, at, at * at); };
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double sigma = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d row = row_at(along(points[i].pixel));
    normal += row * row.transpose(), right += row * across(points[i].pixel);
    sigma = std::max(sigma, points[i].sigma);
  }
  const Eigen::Vector3d curve = solve_definite(normal, right), row = row_at(x);
  // Where the arm's image deviates from a parabola, the deviation is the curve's uncertainty.
  double squares = 0;
  for (std::size_t i = 0; i < count; ++i)
    squares += std::pow(across(points[i].pixel) - curve.dot(row_at(along(points[i].pixel))), 2);
  sigma = std::max(sigma, std::sqrt(squares / static_cast<double>(count - 3)));
  // Correlated neighbours count as one point.
  const double spacing = length / static_cast<double>(count - 1),
               alike = std::max(1.0, 2 * seen.reach.sigma / spacing);
  return Aside{std::abs(across(pixel) - curve.dot(row)) / std::hypot(1, curve[1] + 2 * curve[2] * x),
               sigma * std::sqrt(alike * row.dot(solve_definite(normal, row)))};
}

}  // namespace flexura
