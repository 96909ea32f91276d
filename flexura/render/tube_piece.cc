#include "flexura/render/tube_piece.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "flexura/render/ray.h"

namespace flexura {
namespace {

// Returns the arc length from the piece's start to the point of the centerline nearest to (x, z). Smooth
// through curvature 0.
double arc_length(double curvature, double x, double z) {
  const double opposite = curvature * z, adjacent = 1 - curvature * x;
  if (std::abs(opposite) > 1e-3 * adjacent) return std::atan2(opposite, adjacent) / curvature;
  const double ratio = opposite / adjacent, square = ratio * ratio;
  return z / adjacent * (1 - square * (1.0 / 3 - square * (1.0 / 5 - square / 7)));
}

// Narrows the range to depths with offset + slope * depth >= 0; returns whether this moved the end of the
// range.
bool keep_positive(double offset, double slope, DepthRange& range) {
  if (slope == 0) {
    if (offset < 0) range.to = -infinity;
    return false;
  }
  const double crossing = -offset / slope;
  if (slope > 0) {
    range.from = std::max(range.from, crossing);
    return false;
  }
  if (crossing >= range.to) return false;
  range.to = crossing;
  return true;
}

// Range of depths in which the squared distance to the centerline is concave along the ray; empty (1, 0)
// almost always. It is where m^3 < cross^2 / square; m^2 is quadratic in depth.
struct Stretch {
  double from = 1, to = 0;
};
Stretch concave_stretch(const TubePiece& piece, const LocalRay& ray) {
  const double planar = ray.direction.x() * ray.direction.x() + ray.direction.z() * ray.direction.z();
  const double cross = std::abs(ray.cross), k = piece.curvature;
  if (!(cross * ray.square < planar * std::sqrt(planar)) || !(k * planar > 0)) return {};
  const double bound = std::cbrt(cross * cross / ray.square);
  const double across = (bound * bound - cross * cross / planar) / planar;
  if (!(across > 0)) return {};
  const double half = std::sqrt(across) / k;
  const double along = ray.origin.x() * ray.direction.x() + ray.origin.z() * ray.direction.z();
  const double middle = (ray.direction.x() - k * along) / (k * planar);
  return {middle - half, middle + half};
}

}  // namespace

namespace {

LocalRay local_ray(const TubePiece& piece, const Eigen::Vector3d& origin_P,
                   const Eigen::Vector3d& direction_C, double square) {
  LocalRay local;
  local.origin = origin_P;
  local.direction = piece.R_CP.transpose() * direction_C;
  local.square = square;
  local.cross = piece.is_ball ? 0
                              : (1 - piece.curvature * local.origin.x()) * local.direction.z() +
                                    piece.curvature * local.origin.z() * local.direction.x();
  return local;
}

}  // namespace

LocalRay local_ray(const TubePiece& piece, const Ray& ray) {
  return local_ray(piece, piece.p_PC, ray.direction, ray.direction.squaredNorm());
}

LocalRay local_ray(const TubePiece& piece, const Eigen::Vector3d& p_CQ, const Eigen::Vector3d& direction_C) {
  return local_ray(piece, piece.R_CP.transpose() * (p_CQ - piece.p_CP), direction_C,
                   direction_C.squaredNorm());
}

DepthRange range_of(const TubePiece& piece, const LocalRay& local, double radius) {
  const Eigen::Vector3d way = piece.bound_center - local.origin;
  const double square = local.square;
  const double middle = way.dot(local.direction) / square;
  const double reach = radius * radius - (way - middle * local.direction).squaredNorm();
  if (!(reach > 0)) return {1, 0};
  const double half = std::sqrt(reach / square);
  DepthRange range{std::max(middle - half, 0.0), middle + half};
  if (piece.is_cut_before) range.leaves_before = keep_positive(local.origin.z(), local.direction.z(), range);
  if (piece.is_cut_after) {
    range.leaves_after = keep_positive(piece.end_offset - piece.end_tangent.dot(local.origin),
                                       -piece.end_tangent.dot(local.direction), range);
    if (range.leaves_after) range.leaves_before = false;
  }
  return range;
}

Inside inside_at(const TubePiece& piece, const LocalRay& ray, double depth) {
  const Eigen::Vector3d p = ray.origin + depth * ray.direction;
  const Eigen::Vector3d& d = ray.direction;
  if (piece.is_ball) return {p.squaredNorm() - piece.radius * piece.radius, 2 * p.dot(d), 2 * ray.square};
  const double k = piece.curvature;
  const double q = k * (p.x() * p.x() + p.z() * p.z()) - 2 * p.x();
  const double m_squared = std::max(1 + k * q, 1e-12), m = std::sqrt(m_squared);
  const double w = q / (m + 1);
  const double w_slope = (k * (p.x() * d.x() + p.z() * d.z()) - d.x()) / m;
  double radius = piece.radius, radius_slope = 0;
  if (piece.widening != 0) {
    radius += piece.widening * arc_length(k, p.x(), p.z());
    radius_slope = piece.widening * ray.cross / m_squared;
  }
  return {w * w + p.y() * p.y() - radius * radius, 2 * (w * w_slope + p.y() * d.y() - radius * radius_slope),
          2 * (ray.square - ray.cross * ray.cross / (m_squared * m))};
}

TubePoint tube_point(const TubePiece& piece, const Eigen::Vector3d& p_CQ) {
  const Eigen::Vector3d p = piece.R_CP.transpose() * (p_CQ - piece.p_CP);
  TubePoint point;
  if (piece.is_ball) {
    const double distance = p.norm();
    const Eigen::Vector3d n = distance > 0 ? Eigen::Vector3d(p / distance) : Eigen::Vector3d(1, 0, 0);
    point.s = piece.s, point.gap = distance - piece.radius, point.shrink = 1;
    point.normal = point.outward = piece.R_CP * n;
    point.tangent = piece.R_CP.col(2);
    return point;
  }
  const double k = piece.curvature;
  const double q = k * (p.x() * p.x() + p.z() * p.z()) - 2 * p.x();
  const double m = std::sqrt(std::max(1 + k * q, 1e-12)), w = q / (m + 1);
  const double distance = std::sqrt(w * w + p.y() * p.y());
  const double cosine = (1 - k * p.x()) / m, sine = k * p.z() / m;
  // w grows away from the centre of curvature, which is towards +x.
  const double out = distance > 0 ? w / distance : -1.0, side = distance > 0 ? p.y() / distance : 0.0;
  const double foot = arc_length(k, p.x(), p.z());
  point.s = piece.s + foot;
  point.gap = distance - (piece.radius + piece.widening * foot);
  point.outward = piece.R_CP * Eigen::Vector3d(-out * cosine, side, out * sine);
  point.tangent = piece.R_CP * Eigen::Vector3d(sine, 0, cosine);
  point.shrink = m;
  point.normal = point.outward;
  if (piece.widening != 0) point.normal = (point.outward - piece.widening / m * point.tangent).normalized();
  return point;
}

namespace {

// Returns the zero of the slope, which is negative at `low` and positive at `high`, by bracketed Newton
// steps.
double minimum_between(const TubePiece& piece, const LocalRay& ray, double low, double high) {
  double depth = 0.5 * (low + high);
  for (int step = 0; step < 60; ++step) {
    const Inside at = inside_at(piece, ray, depth);
    const double newton = at.curving > 0 ? -at.slope / at.curving : infinity;
    // If the slope is zero up to rounding, the step may end on the bracket, which needs no halving.
    if (std::abs(newton) < 1e-10 * (1 + depth)) return std::clamp(depth + newton, low, high);
    (at.slope < 0 ? low : high) = depth;
    depth += newton;
    if (!(depth > low) || !(depth < high)) depth = 0.5 * (low + high);
    if (high - low < 1e-10 * (1 + depth)) break;
  }
  return depth;
}

// Returns the zero of the value, which is positive at `low` and negative at `high`, starting at `depth`.
double root_between(const TubePiece& piece, const LocalRay& ray, double low, double high, double depth) {
  if (!(depth > low) || !(depth < high)) depth = 0.5 * (low + high);
  for (int step = 0; step < 80; ++step) {
    const Inside at = inside_at(piece, ray, depth);
    const double newton = at.slope < 0 ? -at.value / at.slope : infinity;
    if (std::abs(newton) < 1e-13 * depth) return std::clamp(depth + newton, low, high);  // As above.
    (at.value > 0 ? low : high) = depth;
    depth += newton;
    if (!(depth > low) || !(depth < high)) depth = 0.5 * (low + high);
    if (high - low < 1e-13 * depth) break;
  }
  return depth;
}

// Returns the entry in a range where the value is convex in depth; adds its minimum if it is a near miss.
double entry_in_convex(const TubePiece& piece, const LocalRay& ray, double low, double high,
                       NearMisses& misses) {
  const Inside at_low = inside_at(piece, ray, low);
  if (at_low.value <= 0 || at_low.slope >= 0) return infinity;
  const Inside at_high = inside_at(piece, ray, high);
  double lowest = high;
  Inside at_lowest = at_high;
  if (at_high.slope > 0) {
    lowest = minimum_between(piece, ray, low, high);
    at_lowest = inside_at(piece, ray, lowest);
    if (at_lowest.value > 0) {
      if (misses.count < 2) misses.depths[static_cast<std::size_t>(misses.count++)] = lowest;
      return infinity;
    }
  } else if (at_high.value > 0) {
    return infinity;
  }
  const double back =
      at_lowest.curving > 0 ? std::sqrt(std::max(0.0, -2 * at_lowest.value / at_lowest.curving)) : 0;
  return root_between(piece, ray, low, lowest, lowest - back);
}

// Returns the minimum in a convex range; infinity if the value still decreases at the end.
double minimum_in_convex(const TubePiece& piece, const LocalRay& ray, double low, double high) {
  if (inside_at(piece, ray, high).slope < 0) return infinity;
  if (inside_at(piece, ray, low).slope >= 0) return low;
  return minimum_between(piece, ray, low, high);
}

// Returns the entry in a concave range. There is an entry if the range ends inside the tube and its highest
// point is outside.
double entry_in_concave(const TubePiece& piece, const LocalRay& ray, double low, double high) {
  const Inside at_low = inside_at(piece, ray, low), at_high = inside_at(piece, ray, high);
  if (at_high.value >= 0) return infinity;
  double highest = low;
  if (at_low.value <= 0) {
    if (at_low.slope <= 0 || at_high.slope >= 0) return infinity;
    double below = low, above = high;
    for (int step = 0; step < 60; ++step) {
      highest = 0.5 * (below + above);
      (inside_at(piece, ray, highest).slope > 0 ? below : above) = highest;
    }
    if (inside_at(piece, ray, highest).value <= 0) return infinity;
  }
  return root_between(piece, ray, highest, high, 0.5 * (highest + high));
}

// Splits the range where the curvature changes its sign and calls visit(from, to, is_concave) on the parts in
// order until it returns a finite depth.
template <typename Visit>
double over_parts(const TubePiece& piece, const LocalRay& ray, const DepthRange& range, Visit&& visit) {
  const Stretch concave = piece.is_ball ? Stretch{} : concave_stretch(piece, ray);
  const double from = std::max(concave.from, range.from), to = std::min(concave.to, range.to);
  if (!(from < to)) return visit(range.from, range.to, false);
  double depth = infinity;
  if (range.from < from) depth = visit(range.from, from, false);
  if (depth == infinity) depth = visit(from, to, true);
  if (depth == infinity && to < range.to) depth = visit(to, range.to, false);
  return depth;
}

}  // namespace

double first_entry(const TubePiece& piece, const LocalRay& ray, const DepthRange& range, NearMisses& misses) {
  return over_parts(piece, ray, range, [&](double low, double high, bool is_concave) {
    return is_concave ? entry_in_concave(piece, ray, low, high)
                      : entry_in_convex(piece, ray, low, high, misses);
  });
}

double first_minimum(const TubePiece& piece, const LocalRay& ray, double depth, const DepthRange& range) {
  DepthRange rest = range;
  rest.from = std::max(depth, range.from);
  return over_parts(piece, ray, rest, [&](double low, double high, bool is_concave) {
    return is_concave ? infinity : minimum_in_convex(piece, ray, low, high);
  });
}

double first_slowdown(const TubePiece& piece, const LocalRay& ray, double depth, const DepthRange& range,
                      bool has_entered) {
  DepthRange rest = range;
  rest.from = std::max(depth, range.from);
  return over_parts(piece, ray, rest, [&](double low, double high, bool is_concave) {
    if (!is_concave) return minimum_in_convex(piece, ray, low, high);
    return has_entered || low > rest.from ? low : infinity;
  });
}

}  // namespace flexura
