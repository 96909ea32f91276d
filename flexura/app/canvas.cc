#include "flexura/app/canvas.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace flexura {
namespace {

using Eigen::Vector2d;

// Maximum distance of drawn lines from the first pixel, px.
constexpr double farthest = 1e6;

}  // namespace

Canvas::Canvas(const Image<std::uint8_t>& picture) : picture_(picture.width(), picture.height(), 3) {
  for (int v = 0; v < picture.height(); ++v)
    for (int u = 0; u < picture.width(); ++u)
      for (int c = 0; c < 3; ++c) picture_.at(u, v, c) = picture.at(u, v, picture.channels() == 3 ? c : 0);
}

void Canvas::dot(const Vector2d& at, const PenColor& color) {
  const double u = std::round(at.x()), v = std::round(at.y());
  const bool is_inside = u >= 0 && v >= 0 && u < picture_.width() && v < picture_.height();
  if (!is_inside) return;
  for (int c = 0; c < 3; ++c)
    picture_.at(static_cast<int>(u), static_cast<int>(v), c) = color[static_cast<std::size_t>(c)];
}

void Canvas::line(const Vector2d& from, const Vector2d& to, const PenColor& color) {
  const Vector2d way = to - from;
  const bool is_near = from.cwiseAbs().maxCoeff() < farthest && to.cwiseAbs().maxCoeff() < farthest;
  if (!is_near) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(way.cwiseAbs().maxCoeff())));
  for (int i = 0; i <= steps; ++i) dot(from + static_cast<double>(i) / steps * way, color);
}

void Canvas::cross(const Vector2d& at, double size, const PenColor& color) {
  line(at - Vector2d(size, 0), at + Vector2d(size, 0), color);
  line(at - Vector2d(0, size), at + Vector2d(0, size), color);
}

void Canvas::ellipse(const EllipseFit& ellipse, const PenColor& color) {
  constexpr int sides = 720;
  const auto at = [&](int i) {
    const double t = 2 * std::numbers::pi * i / sides;
    const Vector2d local(ellipse.semi_axes.x() * std::cos(t), ellipse.semi_axes.y() * std::sin(t));
    return Vector2d(ellipse.center + Eigen::Rotation2Dd(ellipse.angle) * local);
  };
  for (int i = 0; i < sides; ++i) line(at(i), at(i + 1), color);
}

}  // namespace flexura
