#include "flexura/kinematics/curves.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "flexura/math/quadrature.h"
#include "flexura/math/series.h"

namespace flexura {
namespace {

// Returns the distance of p from the arc. In the arc's plane, the nearest point of the whole circle is in the
// direction from the centre to p. If the arc does not contain this point, one of the arc's ends is nearest.
double distance(const Arc& arc, const Eigen::Vector3d& p) {
  const auto distance_at = [&](double s) { return (p - arc.pose(s).position).norm(); };
  const double nearer_end = std::min(distance_at(0.0), distance_at(arc.length));
  const Eigen::Vector3d p_S = arc.X_WS.inverse() * p;
  const double theta = arc.bend.norm();
  if (theta == 0.0) return std::min(nearer_end, distance_at(std::clamp(p_S.z(), 0.0, arc.length)));
  const double radius = arc.length / theta;
  double angle = std::atan2(p_S.z(), radius - arc.bend.dot(p_S.head<2>()) / theta);
  if (angle < 0.0) angle += 2.0 * std::numbers::pi;
  return angle <= theta ? std::min(nearer_end, distance_at(radius * angle)) : nearer_end;
}

double distance(const Backbone& backbone, const Eigen::Vector3d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Arc& arc : backbone.arcs()) nearest = std::min(nearest, distance(arc, p));
  return nearest;
}

// Returns the best length of a circular arc's tangent handle, (4/3) R tan(theta/4) with R = length / theta.
// The formula here avoids 0/0.
double handle_length(double theta, double length) {
  const double quarter = 0.25 * theta;
  return length / 3.0 * sinc(quarter) / std::cos(quarter);
}

}  // namespace

Eigen::Vector3d CubicBezier::at(double u) const {
  const double v = 1.0 - u;
  return (v * v * v) * points[0] + (3.0 * v * v * u) * points[1] + (3.0 * v * u * u) * points[2] +
         (u * u * u) * points[3];
}

Eigen::Vector3d CubicBezier::velocity(double u) const {
  const double v = 1.0 - u;
  return (3.0 * v * v) * (points[1] - points[0]) + (6.0 * v * u) * (points[2] - points[1]) +
         (3.0 * u * u) * (points[3] - points[2]);
}

std::vector<CubicBezier> catmull_rom(std::span<const Eigen::Vector3d> points, double tension) {
  if (points.size() < 2) throw std::invalid_argument("a spline needs at least two points");
  const std::size_t last = points.size() - 1;
  const auto tangent = [&](std::size_t i) -> Eigen::Vector3d {
    const Eigen::Vector3d before = i > 0 ? points[i - 1] : 2.0 * points[0] - points[1];
    const Eigen::Vector3d after = i < last ? points[i + 1] : 2.0 * points[last] - points[last - 1];
    return tension * (after - before);
  };
  std::vector<CubicBezier> spline;
  spline.reserve(last);
  for (std::size_t i = 0; i < last; ++i) {
    spline.push_back(
        {{points[i], points[i] + tangent(i) / 3.0, points[i + 1] - tangent(i + 1) / 3.0, points[i + 1]}});
  }
  return spline;
}

std::vector<CubicBezier> catmull_rom(const Backbone& backbone, int spans, double tension) {
  if (spans < 1)
    throw std::invalid_argument("a section cannot be divided into " + std::to_string(spans) + " spans");
  std::vector<Eigen::Vector3d> points;
  for (const Arc& arc : backbone.arcs()) {
    for (int i = 0; i < spans; ++i) points.push_back(arc.pose(arc.length * i / spans).position);
  }
  points.push_back(backbone.tip().position);
  return catmull_rom(points, tension);
}

std::vector<CubicBezier> tangent_bezier(const Backbone& backbone) {
  std::vector<CubicBezier> curve;
  for (const Arc& arc : backbone.arcs()) {
    const double theta = arc.bend.norm();
    const int count = std::max(1, static_cast<int>(std::ceil(theta / std::numbers::pi)));
    const double handle = handle_length(theta / count, arc.length / count);
    for (int i = 0; i < count; ++i) {
      const Pose start = arc.pose(arc.length * i / count);
      const Pose end = arc.pose(arc.length * (i + 1) / count);
      curve.push_back({{start.position, start.position + handle * start.rotation.col(2),
                        end.position - handle * end.rotation.col(2), end.position}});
    }
  }
  return curve;
}

std::vector<CubicBezier> drawn_curve(const Backbone& backbone, CurveKind kind, double tension) {
  switch (kind) {
    case CurveKind::catmull_rom:
      return catmull_rom(backbone, 1, tension);
    case CurveKind::bezier:
      return tangent_bezier(backbone);
    case CurveKind::arcs:
      break;
  }
  return {};
}

CurveDeviation deviation(std::span<const CubicBezier> curve, const Backbone& backbone) {
  constexpr int samples = 256;
  const Quadrature rule = gauss_legendre(16);
  CurveDeviation result;
  for (const CubicBezier& piece : curve) {
    for (int k = 0; k <= samples; ++k) {
      const Eigen::Vector3d p_WP = piece.at(static_cast<double>(k) / samples);
      result.distance = std::max(result.distance, distance(backbone, p_WP));
    }
    result.length += integrate(rule, [&](double u) { return piece.velocity(u).norm(); }, 0.0, 1.0, 4);
  }
  return result;
}

}  // namespace flexura
