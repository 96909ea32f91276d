#include "flexura/render/cell.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace flexura {
namespace {

// Safety factor for distances to borders, which are exact to first order only.
constexpr double safety = 1.15;

double farthest_corner(const SquarePart& part, const Eigen::Vector2d& from) {
  double farthest = 0;
  for (std::size_t i = 0; i < part.count; ++i) farthest = std::max(farthest, (part.corners[i] - from).norm());
  return farthest;
}

// Returns the position at which the nearest border of a trace crosses the line through `point` along
// `normal`, in px from the point. Empty if this border is another border or has another direction.
std::optional<double> crossing(const Trace& trace, const Eigen::Vector2d& normal, double most) {
  const double along = trace.nearest.towards.dot(normal);
  if (std::abs(along) < 0.9) return std::nullopt;
  const double result = trace.nearest.distance / along;
  if (!(std::abs(result) < most)) return std::nullopt;
  return result;
}

// Returns the mean height of the border over its chord in the square, px along the normal. Uses Simpson's
// rule with the border's ends and middle, each measured from a nearby ray. Empty if the border is not a
// smooth and nearly straight curve.
std::optional<double> mean_height(const Tracer& tracer, const Ray& middle, double half,
                                  const Division& division, const SquarePart& far) {
  const Eigen::Vector2d& normal = division.normal;
  const Eigen::Vector2d center = 0.5 * (far.chord[0] + far.chord[1]);
  const double back = 0.1 * half;
  constexpr double reach = 0.9;  // Share of the chord.
  std::array<double, 3> heights{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double along = reach * (static_cast<double>(i) - 1);
    const Eigen::Vector2d point = center + 0.5 * along * (far.chord[1] - far.chord[0]) - back * normal;
    const auto found = crossing(tracer.trace(moved(middle, point)), normal, 2 * half);
    if (!found || std::abs(*found - back) > 0.16 * half) return std::nullopt;
    heights[i] = *found - back;
  }
  const double bulge = 0.5 * (heights[0] + heights[2]) - heights[1];
  if (std::abs(bulge) > 0.06 * half) return std::nullopt;
  return heights[1] + bulge / (3 * reach * reach);
}

bool is_continued(const Trace& here, const Trace& there) {
  if (!(here.hit.label == there.hit.label)) return false;
  if (here.hit.is_none()) return true;
  return std::abs(here.hit.depth - there.hit.depth) < 0.02 * here.hit.depth;
}

}  // namespace

SquarePart part_beyond(double half, const Eigen::Vector2d& normal, double offset) {
  const std::array<Eigen::Vector2d, 4> square = {
      Eigen::Vector2d(-half, -half), {half, -half}, {half, half}, {-half, half}};
  SquarePart part;
  std::size_t ends = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d &p = square[i], &q = square[(i + 1) % 4];
    const double at_p = p.dot(normal) - offset, at_q = q.dot(normal) - offset;
    if (at_p > 0) part.corners[part.count++] = p;
    if ((at_p > 0) == (at_q > 0)) continue;
    part.corners[part.count] = p + at_p / (at_p - at_q) * (q - p);
    part.chord[std::min<std::size_t>(ends++, 1)] = part.corners[part.count++];
  }
  for (std::size_t i = 1; i + 1 < part.count; ++i) {
    const Eigen::Vector2d a = part.corners[i] - part.corners[0], b = part.corners[i + 1] - part.corners[0];
    const double area = 0.5 * (a.x() * b.y() - a.y() * b.x());
    part.area += area;
    part.centroid += area * (part.corners[0] + (a + b) / 3);
  }
  if (part.area > 0) part.centroid /= part.area;
  return part;
}

std::optional<Stripes> stripes_of(const Tracer& tracer, const Ray& middle, double half, const Trace& here) {
  const double diagonal = safety * half * std::numbers::sqrt2;
  if (here.second.distance > diagonal || here.clear <= diagonal) return std::nullopt;
  const auto s_at = [&](double u, double v) { return tracer.hit(moved(middle, {u * half, v * half})).s; };
  const std::array<double, 4> s = {s_at(-1, -1), s_at(1, -1), s_at(-1, 1), s_at(1, 1)};
  const Eigen::Vector2d slope((s[1] + s[3] - s[0] - s[2]) / (4 * half),
                              (s[2] + s[3] - s[0] - s[1]) / (4 * half));
  const double size = slope.norm();
  // Deviation of s from a linear function.
  const double bulge = 0.25 * (s[0] + s[1] + s[2] + s[3]) - here.hit.s;
  const double twist = 0.25 * (s[0] + s[3] - s[1] - s[2]);
  if (!(std::abs(bulge) + std::abs(twist) < 0.1 * half * size)) return std::nullopt;
  return Stripes{slope / size, size, here.hit.s + bulge / 3};
}

Verdict judge(const Tracer& tracer, const Ray& pixel, const Eigen::Vector2d& center, double half,
              const Trace& here, bool is_last, Division& division) {
  const double diagonal = half * std::numbers::sqrt2;
  if (here.nearest.distance > safety * diagonal) return Verdict::uniform;
  const Verdict otherwise = is_last ? Verdict::uniform : Verdict::unclear;
  if (!is_last && here.second.distance <= safety * diagonal) return otherwise;
  const Ray middle = moved(pixel, center);
  division.normal = here.nearest.towards;
  division.offset = here.nearest.distance;
  SquarePart far = part_beyond(half, division.normal, division.offset);
  if (far.area == 0) far.centroid = division.normal * diagonal;
  // A point far enough beyond the border, even if only a small part of the square is beyond.
  const double beyond = far.centroid.dot(division.normal) - division.offset;
  const Eigen::Vector2d probe = far.centroid + std::max(0.0, 0.1 * half - beyond) * division.normal;
  const Trace there = tracer.trace(moved(middle, probe));
  const auto back = crossing(there, division.normal, 4 * half);
  const bool is_seen =
      back && *back < 0 && std::abs(probe.dot(division.normal) + *back - division.offset) < 0.1 * half;
  if (!is_seen) {
    const bool is_no_border =
        is_continued(here, there) && there.nearest.distance > diagonal + probe.norm() * 0.5;
    return is_no_border ? Verdict::uniform : otherwise;
  }
  if (!is_last) {
    if (there.second.distance <= safety * farthest_corner(far, probe)) return Verdict::unclear;
    if (far.area == 0) return Verdict::uniform;
    const auto height = mean_height(tracer, middle, half, division, far);
    if (!height) return Verdict::unclear;
    division.offset += *height;
  }
  division.far_part = part_beyond(half, division.normal, division.offset);
  if (!(division.far_part.area > 0)) return Verdict::uniform;
  division.far = there.hit;
  return Verdict::divided;
}

}  // namespace flexura
