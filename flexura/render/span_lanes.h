#pragma once

#include <cstddef>
#include <cstdint>

#include "flexura/render/span_kernels.h"
#include "flexura/render/vectors.h"

// Intersection of rays with tubes; only all_kernels.h includes this header.
//
// The centerline's circle passes through the origin, tangent to z, with its centre at x = 1/curvature.
// A point p is on the tube of radius r where
//   H = h^2 + y^2 - r^2 = 0,  h = curvature (|p|^2 - r^2) / 2 - x.
// On the tube, h is the distance from the cylinder through the circle. Along a ray, H is a polynomial. For a
// tapered tube, r is the radius at the point of the centerline nearest to p. Constant r has separate, faster
// code without the terms of the taper.
namespace flexura {
namespace {

struct Vector {
  Wide x, y, z;
};
[[gnu::always_inline]] inline Wide dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[gnu::always_inline]] inline Wide dot(const Vector& a, const float (&b)[3]) {
  return a.x * b[0] + a.y * b[1] + a.z * b[2];
}
[[gnu::always_inline]] inline Vector along(const Vector& p, const Vector& d, const Wide& way) {
  return {p.x + way * d.x, p.y + way * d.y, p.z + way * d.z};
}

// Undistorted positions of pixels relative to a reference pixel, and their derivatives with respect to the
// pixel (u, v).
struct Place {
  Wide u, v;
  Wide u_by_u, u_by_v, v_by_u, v_by_v;
};
[[gnu::always_inline]] inline Wide at(const Linear& f, const Place& place) {
  return f.value + f.by_v * place.v + f.by_u * place.u;
}
// Derivatives with respect to the pixel (u, v).
struct Slope {
  Wide by_u, by_v;
};
[[gnu::always_inline]] inline Slope by_pixel(const Place& place, const Wide& by_u, const Wide& by_v) {
  return {by_u * place.u_by_u + by_v * place.v_by_u, by_u * place.u_by_v + by_v * place.v_by_v};
}

// Returns the positions of the row's pixels from column u on, relative to (u0, v0).
[[gnu::always_inline]] inline Place place_of(const SpanRow& row, int u, float u0, float v0) {
  const LensRow& lens = row.lens;
  if (lens.u == nullptr)
    return {counted() + (static_cast<float>(u) - u0),
            Wide(static_cast<float>(row.v) - v0),
            Wide(1),
            Wide(0),
            Wide(0),
            Wide(1)};
  return {wide_load(lens.u + u) - u0, wide_load(lens.v + u) - v0, wide_load(lens.u_by_u + u),
          wide_load(lens.u_by_v + u), wide_load(lens.v_by_u + u), wide_load(lens.v_by_v + u)};
}
[[gnu::always_inline]] inline Place place_of(const SpanPlaces& places, std::size_t i, float u0, float v0) {
  return {wide_load(places.u + i) - u0, wide_load(places.v + i) - v0, wide_load(places.u_by_u + i),
          wide_load(places.u_by_v + i), wide_load(places.v_by_u + i), wide_load(places.v_by_v + i)};
}

// A ray, and h along the ray from `point` on: h0 + h1 t + h2 t^2. For a tapered tube, without the term of the
// radius.
template <bool is_tapered>
struct RayLanes {
  Vector point, direction;
  Wide depth;  // Depth of the point.
  Wide h0, h1, h2;
};

// Returns the ray of a place, with a point close to the piece's middle.
template <bool is_tapered>
[[gnu::always_inline]] inline RayLanes<is_tapered> ray_of(const SpanPiece& piece, const Place& place) {
  RayLanes<is_tapered> ray;
  const Vector start{at(piece.point[0], place), at(piece.point[1], place), at(piece.point[2], place)};
  const Vector& d = ray.direction = {at(piece.direction[0], place), at(piece.direction[1], place),
                                     at(piece.direction[2], place)};
  const Wide way = at(piece.way, place);
  const Vector& p = ray.point = along(start, d, way);
  ray.depth = piece.depth0 + way;
  const float k = piece.curvature, half = 0.5f * k, square = is_tapered ? 0 : piece.radius * piece.radius;
  ray.h0 = half * (dot(p, p) - square) - p.x;
  ray.h1 = k * dot(p, d) - d.x;
  ray.h2 = half * dot(d, d);
  return ray;
}

// Returns atan(x) / x as a function of x^2 up to 1, with an error of 2e-8 (Abramowitz, Stegun, 4.4.49);
// constant beyond.
[[gnu::always_inline]] inline Wide arc_by_tangent(const Wide& x_square) {
  const Wide q = choose(x_square < 1, x_square, Wide(1));
  return 1 + q * (-0.3333314528f +
                  q * (0.1999355085f +
                       q * (-0.1420889944f +
                            q * (0.1065626393f +
                                 q * (-0.0752896400f +
                                      q * (0.0429096138f + q * (-0.0161657367f + q * 0.0028662257f)))))));
}

// Radius of the tube at the point of the centerline nearest to p.
struct Girth {
  Wide radius;
  Wide by_x, by_z;  // Gradient of the radius with respect to p.
};
[[gnu::always_inline]] inline Girth girth_at(const SpanPiece& piece, const Vector& p) {
  const Wide opposite = piece.curvature * p.z, adjacent = at_least(0.1f, 1 - piece.curvature * p.x),
             inverse = 1 / adjacent, ratio = opposite * inverse, square = ratio * ratio;
  const Wide slope = piece.widening * inverse * inverse / (1 + square);
  return {piece.radius + piece.widening * (p.z * inverse) * arc_by_tangent(square), slope * opposite,
          slope * adjacent};
}

// H, half of its derivatives along the ray, and the radius.
struct Height {
  Wide value, slope, curving, radius;
};
[[gnu::always_inline]] inline Height height(const SpanPiece& piece, const RayLanes<false>& ray,
                                            const Wide& t) {
  const float square = piece.radius * piece.radius;
  const Wide way = ray.h2 * t, h = ray.h0 + t * (ray.h1 + way), h_slope = ray.h1 + 2 * way;
  const Wide y = ray.point.y + t * ray.direction.y;
  return {h * h + y * y - square, h * h_slope + y * ray.direction.y,
          h_slope * h_slope + 2 * h * ray.h2 + ray.direction.y * ray.direction.y, Wide(piece.radius)};
}
// Uses only the first derivative of the radius, because the radius is almost linear along a ray.
[[gnu::always_inline]] inline Height height(const SpanPiece& piece, const RayLanes<true>& ray,
                                            const Wide& t) {
  const Vector& d = ray.direction;
  const Vector p = along(ray.point, d, t);
  const Girth girth = girth_at(piece, p);
  const float k = piece.curvature;
  const Wide r = girth.radius, r_slope = girth.by_x * d.x + girth.by_z * d.z;
  const Wide way = ray.h2 * t, h = ray.h0 + t * (ray.h1 + way) - 0.5f * k * r * r,
             h_slope = ray.h1 + 2 * way - k * r * r_slope, h_curving = 2 * ray.h2 - k * r_slope * r_slope;
  return {h * h + p.y * p.y - r * r, h * h_slope + p.y * d.y - r * r_slope,
          h_slope * h_slope + h * h_curving + d.y * d.y - r_slope * r_slope, r};
}

// Minimum of H along the ray, and the radius at the minimum.
struct Lowest {
  Wide t, value, half_chord, radius;
  WideMask is_sure;
};
template <bool is_tapered>
[[gnu::always_inline]] inline Lowest lowest_of(const SpanPiece& piece, const RayLanes<is_tapered>& ray,
                                               int steps) {
  Wide t = Wide(0), at_start = Wide(0);
  for (int i = 1; i < steps; ++i) {
    const Height here = height(piece, ray, t);
    if (i == 1) at_start = here.value;
    t -= here.slope / here.curving;
  }
  const Height here = height(piece, ray, t);
  if (steps <= 1) at_start = here.value;
  // If H is larger than at the start, this is another minimum of H.
  const float rounding = 0.01f * piece.radius * piece.radius;
  const Wide scale = 1 / here.curving, move = here.slope * scale, value = here.value - here.slope * move;
  Lowest lowest{t - move, value, square_root(at_least(0, -(value * scale))), here.radius,
                (here.curving > 0) & (size_of(move) <= piece.largest_move) & (value <= at_start + rounding)};
  if (is_tapered) lowest.radius = girth_at(piece, along(ray.point, ray.direction, lowest.t)).radius;
  return lowest;
}

// Entry of the ray into the tube, if any. `move` is the length of the last Newton step, m; where H does not
// decrease, it is the distance from the surface.
struct Entry {
  Wide t, move;
};
template <bool is_tapered>
[[gnu::always_inline]] inline Entry entry_of(const SpanPiece& piece, const RayLanes<is_tapered>& ray,
                                             const Lowest& lowest) {
  Wide t = lowest.t - lowest.half_chord, move = Wide(0);
  for (int i = 0; i < piece.refining; ++i) {
    const Height here = height(piece, ray, t);
    const WideMask is_falling = here.slope < 0;
    const Wide step = choose(is_falling, 0.5f * here.value / here.slope, Wide(0));
    t -= step;
    move = choose(is_falling, step, here.value / piece.radius);
  }
  return {t, move};
}

// Returns whether p is at most `before` outside the plane at the piece's start, and at most `after` outside
// the plane at its end.
[[gnu::always_inline]] inline WideMask is_within(const SpanPiece& piece, const Vector& p, float before,
                                                 float after) {
  const Wide beyond = piece.end_sine * p.x + piece.end_cosine * p.z - piece.end_offset;
  return (p.z >= -before) & (beyond <= after);
}
[[gnu::always_inline]] inline WideMask is_within(const SpanPiece& piece, const Vector& p, float slack) {
  return is_within(piece, p, slack, slack);
}
// Overlap of neighbouring pieces as a fraction of their radius.
constexpr float overlap = 1e-3f;

// Returns the normal of the tube at a point p of its surface, times the radius at the piece's start.
[[gnu::always_inline]] inline Vector normal_of(const SpanPiece& piece, const RayLanes<false>& ray,
                                               const Vector& p, const Wide& t) {
  const Wide h = ray.h0 + t * (ray.h1 + t * ray.h2);
  const Wide scale = h / (1 + piece.curvature * h);
  return {scale * (piece.curvature * p.x - 1), p.y, scale * (piece.curvature * p.z)};
}
[[gnu::always_inline]] inline Vector normal_of(const SpanPiece& piece, const RayLanes<true>& ray,
                                               const Vector& p, const Wide& t) {
  const Girth girth = girth_at(piece, p);
  const Wide r = girth.radius;
  const Wide h = ray.h0 + t * (ray.h1 + t * ray.h2) - 0.5f * piece.curvature * r * r;
  const Wide scale = h / (1 + piece.curvature * h);
  const Vector out{scale * (piece.curvature * p.x - 1) - r * girth.by_x, p.y,
                   scale * (piece.curvature * p.z) - r * girth.by_z};
  const Wide size = piece.radius / square_root(at_least(1e-30f, dot(out, out)));
  return {size * out.x, size * out.y, size * out.z};
}

// Relation of a ray to a piece, ignoring the piece's ends, with the given number of steps to the deepest
// point.
template <bool is_tapered>
struct PieceView {
  RayLanes<is_tapered> ray;
  Lowest lowest;
  Entry entry;
  Vector p;
  Wide depth;
  WideMask is_settled;
};
template <bool is_tapered>
[[gnu::always_inline]] inline PieceView<is_tapered> see(const SpanPiece& piece, const Place& place,
                                                        int steps) {
  PieceView<is_tapered> piece_view;
  piece_view.ray = ray_of<is_tapered>(piece, place);
  piece_view.lowest = lowest_of(piece, piece_view.ray, steps);
  piece_view.entry = entry_of(piece, piece_view.ray, piece_view.lowest);
  piece_view.p = along(piece_view.ray.point, piece_view.ray.direction, piece_view.entry.t);
  piece_view.depth = piece_view.ray.depth + piece_view.entry.t;
  piece_view.is_settled = size_of(piece_view.entry.move) < piece.settled;
  return piece_view;
}

// Part of a pixel's square beyond a line, where x . normal > offset, for a unit normal or a zero vector.
struct SquarePart {
  Wide area, x, y;  // Centroid, where the area is not 0.
};
[[gnu::always_inline]] inline SquarePart part_beyond(const Wide& normal_x, const Wide& normal_y,
                                                     const Wide& offset) {
  const Wide size_x = size_of(normal_x), size_y = size_of(normal_y);
  const WideMask is_steep = size_x < size_y;
  // If the function is constant in the image, there is no normal, and the whole square is on one side.
  constexpr float least = 1e-6f;
  const Wide a = at_least(least, choose(is_steep, size_y, size_x)),
             b = at_least(least, choose(is_steep, size_x, size_y));
  // Area of the triangle at the nearer corner, then of the band if the line crosses opposite sides.
  const Wide far = size_of(offset);
  const Wide t = at_least(0, 0.5f * (a + b) - far);
  const Wide corner = t * t / (2 * a * b), corner_x = 0.5f - t / (3 * a), corner_y = 0.5f - t / (3 * b);
  const Wide rest = 1 - corner, share = corner / at_least(1e-20f, rest);
  const WideMask is_small = offset > 0;
  SquarePart part{choose(is_small, corner, rest), choose(is_small, corner_x, share * corner_x),
                  choose(is_small, corner_y, share * corner_y)};
  const WideMask is_band = far < 0.5f * (a - b);
  const Wide ratio = offset / a, slope = b / a, band = 0.5f - ratio;
  const Wide safe = at_least(1e-6f, band);
  part.area = choose(is_band, band, part.area);
  part.x = choose(is_band, (0.125f - 0.5f * ratio * ratio - slope * slope / 24) / safe, part.x);
  part.y = choose(is_band, slope / (12 * safe), part.y);
  const Wide x = choose(is_steep, part.y, part.x), y = choose(is_steep, part.x, part.y);
  part.x = choose(normal_x < 0, -x, x);
  part.y = choose(normal_y < 0, -y, y);
  return part;
}

// Returns the square of the larger component of a unit normal, or at least 0.5 for a zero vector.
[[gnu::always_inline]] inline Wide larger_square(const Wide& normal_x, const Wide& normal_y) {
  return at_least(0.5f,
                  choose(size_of(normal_x) > size_of(normal_y), normal_x * normal_x, normal_y * normal_y));
}

// Returns the fraction of the pixel beyond the edge, computed from the distance in space and its derivative
// in the image.
template <bool is_tapered>
[[gnu::always_inline]] inline Wide share_beyond(const SpanPiece& piece, const SpanEdge& edge,
                                                const RayLanes<is_tapered>& ray, const Place& place,
                                                const Wide& depth, const Vector& normal,
                                                const Wide& distance) {
  const Wide along_ray = dot(ray.direction, edge.normal);
  const Wide slant = along_ray / dot(normal, ray.direction);
  const auto slope = [&](float Linear::* by) {
    const float(&n)[3] = edge.normal;
    const float x = piece.direction[0].*by, y = piece.direction[1].*by, z = piece.direction[2].*by;
    const float aside = n[0] * x + n[1] * y + n[2] * z;
    return depth * (aside - slant * (normal.x * x + normal.y * y + normal.z * z));
  };
  const auto [by_u, by_v] = by_pixel(place, slope(&Linear::by_u), slope(&Linear::by_v));
  const Wide scale = 1 / square_root(at_least(1e-30f, by_u * by_u + by_v * by_v));
  return part_beyond(by_u * scale, by_v * scale, -distance * scale).area;
}

// Computes the light of the surface at p: the mean over the pixel, or the light at the point alone. Always
// computes three channels, because additional channels take almost no time.
template <bool is_pixel, bool is_tapered>
[[gnu::always_inline]] inline void skin_light(const SpanPiece& piece, const RayLanes<is_tapered>& ray,
                                              const Place& place, const Wide& depth, const Vector& p,
                                              const Vector& normal, Wide (&light)[3]) {
  for (std::size_t c = 0; c < 3; ++c) light[c] = Wide(piece.albedo[c]);
  for (std::size_t i = 0; i < piece.edge_count; ++i) {
    const SpanEdge& edge = piece.edges[i];
    const Wide distance = dot(p, edge.normal) - edge.offset;
    Wide share = choose(distance > 0, Wide(1), Wide(0));
    const WideMask is_near = size_of(distance) < edge.far;
    if (is_pixel && any(is_near))
      share = choose(is_near, share_beyond(piece, edge, ray, place, depth, normal, distance), share);
    for (std::size_t c = 0; c < 3; ++c) light[c] += share * edge.change[c];
  }
  const Wide factor = piece.ambient + at_least(0, dot(normal, piece.light));
  for (Wide& channel : light) channel *= factor;
}

// Computes the light at the point alone.
template <bool is_tapered>
[[gnu::always_inline]] inline void skin_light(const SpanPiece& piece, const Place& place,
                                              const PieceView<is_tapered>& piece_view, Wide (&light)[3]) {
  skin_light<false>(piece, piece_view.ray, place, piece_view.depth, piece_view.p,
                    normal_of(piece, piece_view.ray, piece_view.p, piece_view.entry.t), light);
}

}  // namespace
}  // namespace flexura
