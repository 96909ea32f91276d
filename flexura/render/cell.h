#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <numbers>
#include <optional>

#include "flexura/render/ray.h"
#include "flexura/render/tracer.h"

namespace flexura {

/// Returns the ray of the image point that is `offset`, px, from the image point of `ray`. The lens is
/// linearised.
[[nodiscard]] inline Ray moved(const Ray& ray, const Eigen::Vector2d& offset) {
  Ray result = ray;
  result.direction.head<2>() += ray.by_pixel * offset;
  return result;
}

/// The part of a square beyond a straight line. The square has sides of the length 2 * `half`, and its centre
/// at the origin.
struct SquarePart {
  std::array<Eigen::Vector2d, 6> corners;
  std::size_t count = 0;
  double area = 0;
  Eigen::Vector2d centroid = {0, 0};
  /// Points at which the line enters and leaves the square, if the area is not 0.
  std::array<Eigen::Vector2d, 2> chord;
};
/// Returns the part of the square beyond the line x . normal = offset. `normal` is a unit vector that points
/// to this part.
[[nodiscard]] SquarePart part_beyond(double half, const Eigen::Vector2d& normal, double offset);

/// A square of the image that one straight border divides into two uniform parts.
struct Division {
  Eigen::Vector2d normal;  ///< Unit normal of the border, from the near to the far surface.
  double offset = 0;       ///< Distance of the border from the square's centre, px.
  Hit far;
  SquarePart far_part;
};

/// Linear model of the arm's arc length over a square of the image. At the distance x, px, from the square's
/// middle along the normal, the arc length is s + slope x.
struct Stripes {
  Eigen::Vector2d normal;
  double slope = 0;  ///< Change of arc length per pixel along the normal, m/px; > 0.
  double s = 0;      ///< Arc length in the middle of the square, m.
};
/// Returns the stripes if several edges of rings cross the square around `middle` as parallel lines and no
/// other border is in the square. Returns std::nullopt otherwise, and if the edges are too curved.
[[nodiscard]] std::optional<Stripes> stripes_of(const Tracer& tracer, const Ray& middle, double half,
                                                const Trace& here);

/// Calls sink(hit, ray, area) for each stripe of the square around `middle`.
template <typename Sink>
void cover_stripes(const Tracer& tracer, const Ray& middle, double half, const Stripes& stripes, Hit hit,
                   Sink&& sink) {
  const auto& rings = tracer.stage().rings;
  const double reach = stripes.slope * half * std::numbers::sqrt2;
  auto next = std::ranges::upper_bound(rings, stripes.s - reach, {}, &RingStretch::s);
  double from = stripes.s - reach;
  for (SquarePart rest = part_beyond(half, stripes.normal, -2 * half); rest.area > 0; ++next) {
    const double to = next == rings.end() ? stripes.s + reach : std::min(next->s, stripes.s + reach);
    const SquarePart beyond = part_beyond(half, stripes.normal, (to - stripes.s) / stripes.slope);
    const double area = rest.area - beyond.area;
    hit.s = 0.5 * (from + to);
    hit.label = arm_label(tracer.stage(), tracer.stage().pieces[hit.part.index], hit.s);
    if (area > 0)
      sink(hit, moved(middle, (rest.area * rest.centroid - beyond.area * beyond.centroid) / area), area);
    from = to;
    rest = beyond;
    if (to == stripes.s + reach) return;
  }
}

enum class Verdict { uniform, divided, unclear };

/// Classifies a square with sides of length 2 half, px, around `center`, px from the pixel's ray. Uses the
/// trace `here` in the square's middle and, if needed, a few more rays. If `is_last` is true, returns the
/// best guess instead of `unclear`.
[[nodiscard]] Verdict judge(const Tracer& tracer, const Ray& pixel, const Eigen::Vector2d& center,
                            double half, const Trace& here, bool is_last, Division& division);

/// Maximum number of times that a square's side is halved.
inline constexpr int most_halvings = 4;

/// Integrates over a square around `center` with sides of the length 2 * `half`: calls sink(hit, ray, area)
/// for each uniform part. The area is in px^2. The ray is within the part or next to it. The sum of the areas
/// is the square's area.
template <typename Sink>
void cover(const Tracer& tracer, const Ray& pixel, const Eigen::Vector2d& center, double half, int halvings,
           const Trace& seen, Sink&& sink) {
  const double area = 4 * half * half;
  // On a border the ray may hit either side; a small step away from the border makes the side unique.
  constexpr double step = 1e-5;
  const bool is_on_border = seen.nearest.distance < 0.01 * step;
  const Trace here = is_on_border ? tracer.trace(moved(pixel, center - step * seen.nearest.towards)) : seen;
  const Ray ray = moved(pixel, center);
  if (const auto stripes = stripes_of(tracer, ray, half, here)) {
    cover_stripes(tracer, ray, half, *stripes, here.hit, sink);
    return;
  }
  Division division;
  switch (judge(tracer, pixel, center, half, here, halvings == most_halvings, division)) {
    case Verdict::uniform:
      sink(here.hit, ray, area);
      return;
    case Verdict::divided: {
      const double near_area = area - division.far_part.area;
      sink(division.far, moved(ray, division.far_part.centroid), division.far_part.area);
      // The centroid of the near part represents its mean light better than the square's centre.
      if (near_area > 0) {
        const Ray middle = moved(ray, division.far_part.centroid * (-division.far_part.area / near_area));
        const Hit near = tracer.hit(middle);
        const bool is_same = near.label == here.hit.label;
        sink(is_same ? near : here.hit, is_same ? middle : ray, near_area);
      }
      return;
    }
    case Verdict::unclear:
      break;
  }
  for (const double v : {-0.5, 0.5}) {
    for (const double u : {-0.5, 0.5}) {
      const Eigen::Vector2d quarter = center + half * Eigen::Vector2d(u, v);
      cover(tracer, pixel, quarter, 0.5 * half, halvings + 1, tracer.trace(moved(pixel, quarter)), sink);
    }
  }
}

}  // namespace flexura
