#pragma once

#include <cstddef>
#include <cstdint>

#include "flexura/render/span_kernels.h"
#include "flexura/render/vectors.h"

// Rays against tubes, for span_*.cc alone. Every operation works on each pixel by itself and rounds once, so
// that the width of the vectors changes no bit.
//
// With the centreline's circle through the origin, tangent to z, its centre at x = 1/curvature, a point p is
// on the tube of radius r where
//   H = h^2 + y^2 - r^2 = 0,  h = curvature (|p|^2 - r^2) / 2 - x:
// on the tube h is the distance from the circle's cylinder, and along a ray H is a polynomial.
namespace flexura {
namespace {

static_assert(span_step % lanes == 0);
using Mask = decltype(Floats{} < Floats{});

[[gnu::always_inline]] inline Floats choose(const Mask& mask, const Floats& a, const Floats& b) {
  return mask ? a : b;
}

[[gnu::always_inline]] inline Floats larger(const Floats& a, const Floats& b) { return choose(a > b, a, b); }

struct Vector {
  Floats x, y, z;
};
[[gnu::always_inline]] inline Floats dot(const Vector& a, const Vector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[gnu::always_inline]] inline Floats dot(const Vector& a, const float (&b)[3]) {
  return a.x * b[0] + a.y * b[1] + a.z * b[2];
}
inline float dot(const float (&a)[3], const float (&b)[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
[[gnu::always_inline]] inline Vector along(const Vector& p, const Vector& d, const Floats& way) {
  return {p.x + way * d.x, p.y + way * d.y, p.z + way * d.z};
}
[[gnu::always_inline]] inline Floats at(const Linear& f, const Floats& u, const Floats& v) {
  return f.value + f.by_v * v + f.by_u * u;
}

// A ray, and H along it from `point` on: h = h0 + h1 t + h2 t^2.
struct RayLanes {
  Vector point = {}, direction = {};
  Floats depth = {};  // Of the point.
  Floats h0 = {}, h1 = {}, h2 = {};
};
struct Height {
  Floats value, slope, curving;
};

[[gnu::always_inline]] inline Height height(const RayLanes& ray, float square, const Floats& t) {
  const Floats h = ray.h0 + t * (ray.h1 + t * ray.h2), h_slope = ray.h1 + 2 * ray.h2 * t;
  const Floats y = ray.point.y + t * ray.direction.y;
  return {h * h + y * y - square, 2 * (h * h_slope + y * ray.direction.y),
          2 * (h_slope * h_slope + 2 * h * ray.h2 + ray.direction.y * ray.direction.y)};
}

// From the point nearest to the chord; u, v from the piece's own pixel.
[[gnu::always_inline]] inline RayLanes ray_of(const SpanPiece& piece, const Floats& u, const Floats& v) {
  RayLanes ray;
  const Vector start{at(piece.point[0], u, v), at(piece.point[1], u, v), at(piece.point[2], u, v)};
  const Vector& d = ray.direction = {at(piece.direction[0], u, v), at(piece.direction[1], u, v),
                                     at(piece.direction[2], u, v)};
  const Vector from{start.x - piece.middle[0], start.y - piece.middle[1], start.z - piece.middle[2]};
  const Floats along_chord = dot(d, piece.chord), square = dot(d, d);
  const Floats way =
      (dot(from, piece.chord) * along_chord - dot(from, d)) / (square - along_chord * along_chord);
  const Vector& p = ray.point = along(start, d, way);
  ray.depth = piece.depth0 + way;
  const float half = 0.5f * piece.curvature, radius = piece.radius;
  ray.h0 = half * (dot(p, p) - radius * radius) - p.x;
  ray.h1 = piece.curvature * dot(p, d) - d.x;
  ray.h2 = half * square;
  return ray;
}

// Where H is least, and what it is there.
struct Lowest {
  Floats t, value, curving;
};
template <int steps>
[[gnu::always_inline]] inline Lowest lowest_of(const RayLanes& ray, float square) {
  Lowest lowest{Floats{}, Floats{}, Floats{}};
  for (int i = 0; i < steps; ++i) {
    const Height here = height(ray, square, lowest.t);
    const Floats move = here.slope / here.curving;
    lowest = {lowest.t - move, here.value - 0.5f * here.slope * move, here.curving};
  }
  return lowest;
}

// Where the ray enters, if it does.
[[gnu::always_inline]] inline Floats entry_of(const RayLanes& ray, float square, const Lowest& lowest) {
  Floats t = lowest.t - square_root(at_least(0, -2 * lowest.value / lowest.curving));
  for (int i = 0; i < 2; ++i) {
    const Height here = height(ray, square, t);
    t -= choose(here.slope < 0, here.value / here.slope, Floats{});
  }
  return t;
}

[[gnu::always_inline]] inline Mask is_within(const SpanPiece& piece, const Vector& p) {
  const float slack = 1e-3f * piece.radius;
  const Floats beyond = piece.end_sine * p.x + piece.end_cosine * p.z - piece.end_offset;
  return (p.z >= -slack) & (beyond <= slack);
}

// The normal, times the radius, of the tube at p on it.
[[gnu::always_inline]] inline Vector normal_of(const SpanPiece& piece, const RayLanes& ray, const Vector& p,
                                               const Floats& t) {
  const Floats h = ray.h0 + t * (ray.h1 + t * ray.h2);
  const Floats scale = h / (1 + piece.curvature * h);
  return {scale * (piece.curvature * p.x - 1), p.y, scale * (piece.curvature * p.z)};
}

[[gnu::always_inline]] inline Floats shade(const SpanPiece& piece, const Vector& normal) {
  return piece.ambient + at_least(0, dot(normal, piece.light));
}

// The part of a pixel's square that lies beyond a line: where x . normal > offset, the normal of unit length.
struct SquarePart {
  Floats area, x, y;  // And its centroid, where the area is not 0.
};
[[gnu::always_inline]] inline SquarePart part_beyond(const Floats& normal_x, const Floats& normal_y,
                                                     const Floats& offset) {
  const Floats size_x = choose(normal_x < 0, -normal_x, normal_x),
               size_y = choose(normal_y < 0, -normal_y, normal_y);
  const Mask is_steep = size_x < size_y;
  const Floats a = choose(is_steep, size_y, size_x), b = at_least(1e-6f, choose(is_steep, size_x, size_y));
  // The triangle at the nearer corner; then the band, when the line crosses opposite sides.
  const Floats far = choose(offset < 0, -offset, offset);
  const Floats t = at_least(0, 0.5f * (a + b) - far);
  const Floats corner = t * t / (2 * a * b), corner_x = 0.5f - t / (3 * a), corner_y = 0.5f - t / (3 * b);
  const Floats rest = 1 - corner, share = corner / at_least(1e-20f, rest);
  const Mask is_small = offset > 0;
  SquarePart part{choose(is_small, corner, rest), choose(is_small, corner_x, share * corner_x),
                  choose(is_small, corner_y, share * corner_y)};
  const Mask is_band = far < 0.5f * (a - b);
  const Floats ratio = offset / a, slope = b / a, band = 0.5f - ratio;
  const Floats safe = at_least(1e-6f, band);
  part.area = choose(is_band, band, part.area);
  part.x = choose(is_band, (0.125f - 0.5f * ratio * ratio - slope * slope / 24) / safe, part.x);
  part.y = choose(is_band, slope / (12 * safe), part.y);
  const Floats x = choose(is_steep, part.y, part.x), y = choose(is_steep, part.x, part.y);
  part.x = choose(normal_x < 0, -x, x);
  part.y = choose(normal_y < 0, -y, y);
  return part;
}

[[gnu::always_inline]] inline bool any(const Mask& mask) { return !is_zero(reinterpret_cast<Words>(mask)); }

// The share of the pixel beyond the edge, from the distance in space and how it changes in the image.
[[gnu::always_inline]] inline Floats share_beyond(const SpanPiece& piece, const SpanEdge& edge,
                                                  const RayLanes& ray, const Floats& depth,
                                                  const Vector& normal, const Floats& distance) {
  const Floats along_ray = dot(ray.direction, edge.normal);
  const Floats slant = along_ray / dot(normal, ray.direction);
  const auto slope = [&](float Linear::* by) {
    const float d[3] = {piece.direction[0].*by, piece.direction[1].*by, piece.direction[2].*by};
    return depth * (dot(edge.normal, d) - slant * dot(normal, d));
  };
  const Floats by_u = slope(&Linear::by_u), by_v = slope(&Linear::by_v);
  const Floats scale = 1 / square_root(at_least(1e-30f, by_u * by_u + by_v * by_v));
  return part_beyond(by_u * scale, by_v * scale, -distance * scale).area;
}

// The light of the skin at p, channel by channel; of its pixel, or of the point alone.
template <bool is_pixel>
[[gnu::always_inline]] inline void skin_light(const SpanPiece& piece, const RayLanes& ray,
                                              const Floats& depth, const Vector& p, const Vector& normal,
                                              Floats (&light)[3]) {
  for (std::size_t c = 0; c < piece.channels; ++c) light[c] = Floats{} + piece.albedo[c];
  for (std::size_t i = 0; i < piece.edge_count; ++i) {
    const SpanEdge& edge = piece.edges[i];
    const Floats distance = dot(p, edge.normal) - edge.offset;
    Floats share = choose(distance > 0, Floats{} + 1, Floats{});
    const Mask is_near = (distance < edge.far) & (distance > -edge.far);
    if (is_pixel && any(is_near))
      share = choose(is_near, share_beyond(piece, edge, ray, depth, normal, distance), share);
    for (std::size_t c = 0; c < piece.channels; ++c) light[c] += share * edge.change[c];
  }
  const Floats factor = shade(piece, normal);
  for (std::size_t c = 0; c < piece.channels; ++c) light[c] *= factor;
}

[[gnu::always_inline]] inline std::uint32_t bits_of(const Mask& mask) {
#if defined(__AVX512BW__)
  const auto m = reinterpret_cast<__m512i>(mask);
  return _mm512_test_epi32_mask(m, m);
#elif defined(__AVX2__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#elif defined(__SSE2__)
  return static_cast<std::uint32_t>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < lanes; ++i) bits |= mask[i] != 0 ? 1u << i : 0u;
  return bits;
#endif
}

[[gnu::always_inline]] inline void store_light(const Floats (&light)[3], std::size_t channels,
                                               const Mask& mask, float* to) {
  if (channels == 1) {
    store(to, choose(mask, light[0], load(to)));
    return;
  }
  float values[3][lanes];
  for (std::size_t c = 0; c < 3; ++c) store(values[c], light[c]);
  const std::uint32_t bits = bits_of(mask);
  for (std::size_t i = 0; i < lanes; ++i) {
    if ((bits >> i & 1) == 0) continue;
    for (std::size_t c = 0; c < 3; ++c) to[3 * i + c] = values[c][i];
  }
}

[[gnu::always_inline]] inline Floats counted() {
  Floats count;
  for (std::size_t i = 0; i < lanes; ++i) count[i] = static_cast<float>(i);
  return count;
}

// Step by step for all vectors of a span: what is computed for one waits for what was computed just before,
// and the others fill the time.
constexpr std::size_t vectors = span_step / lanes;

struct SpanLanes {
  RayLanes ray[vectors] = {};
  Lowest lowest[vectors] = {};
  Floats t[vectors] = {};
};

[[gnu::always_inline]] inline void draw_lanes(const SpanPiece& piece, const SpanLanes& span, std::size_t i,
                                              const Mask& is_inside, const SpanPixels& pixels) {
  const RayLanes& ray = span.ray[i];
  const Vector p = along(ray.point, ray.direction, span.t[i]);
  float* const depths = pixels.depth + i * lanes;
  const Floats depth = ray.depth + span.t[i], before = load(depths);
  const Mask is_drawn = is_inside & is_within(piece, p) & (depth < before);
  const std::uint32_t drawn = bits_of(is_drawn);
  if (drawn == 0) return;
  Floats light[3];
  skin_light<true>(piece, ray, depth, p, normal_of(piece, ray, p, span.t[i]), light);
  store(depths, choose(is_drawn, depth, before));
  store_light(light, piece.channels, is_drawn, pixels.light + i * lanes * piece.channels);
  for (std::size_t j = 0; j < lanes; ++j) {
    std::uint8_t& state = pixels.state[i * lanes + j];
    state = static_cast<std::uint8_t>(state | (drawn >> j & 1));
  }
}

std::uint32_t draw(const SpanPiece& piece, const SpanPixels& pixels) {
  const float radius = piece.radius, square = radius * radius, reach = piece.reach;
  const Floats v = Floats{} + (static_cast<float>(pixels.v) - piece.v0);
  SpanLanes span;
  Mask is_near[vectors], is_inside[vectors], any_near = {};
  for (std::size_t i = 0; i < vectors; ++i)
    span.ray[i] =
        ray_of(piece, counted() + (static_cast<float>(pixels.u + static_cast<int>(i * lanes)) - piece.u0), v);
  for (std::size_t i = 0; i < vectors; ++i) {
    span.lowest[i] = lowest_of<2>(span.ray[i], square);
    is_near[i] = span.lowest[i].value < reach * (2 * radius + reach);
    is_inside[i] = span.lowest[i].value < -reach * (2 * radius - reach);
    any_near |= is_near[i];
  }
  if (!any(any_near)) return 0;
  std::uint32_t borders = 0;
  for (std::size_t i = 0; i < vectors; ++i) span.t[i] = entry_of(span.ray[i], square, span.lowest[i]);
  for (std::size_t i = 0; i < vectors; ++i) {
    const Mask is_border = is_near[i] & ~is_inside[i];
    if (!any(is_border)) continue;
    const RayLanes& ray = span.ray[i];
    const Mask is_here = is_within(piece, along(ray.point, ray.direction, span.t[i]));
    const Mask is_passing = is_within(piece, along(ray.point, ray.direction, span.lowest[i].t));
    borders |= bits_of(is_border & (is_passing | (is_here & (span.lowest[i].value < 0)))) << (i * lanes);
  }
  for (std::size_t i = 0; i < vectors; ++i) draw_lanes(piece, span, i, is_inside[i], pixels);
  return borders;
}

void divide(const SpanPiece& piece, const float* us, const float* vs, BorderPixels& borders) {
  const float radius = piece.radius, square = radius * radius;
  for (std::size_t i = 0; i < span_step; i += lanes) {
    const Floats u = load(us + i) - piece.u0, v = load(vs + i) - piece.v0;
    const RayLanes ray = ray_of(piece, u, v);
    const Lowest lowest = lowest_of<4>(ray, square);
    const Floats contour = ray.depth + lowest.t;
    // Of sqrt(h^2 + y^2), which is the radius on the contour.
    const Floats distance = square_root(at_least(1e-30f, lowest.value + square));
    const Floats gap = distance - radius;
    const Vector near = along(ray.point, ray.direction, lowest.t);
    const Floats h = ray.h0 + lowest.t * (ray.h1 + lowest.t * ray.h2), k = Floats{} + piece.curvature;
    const Vector gradient{h * (k * near.x - 1), near.y * (1 + k * h), h * (k * near.z)};
    const Floats scale = contour / distance;
    const auto slope = [&](float Linear::* by) {
      const float d[3] = {piece.direction[0].*by, piece.direction[1].*by, piece.direction[2].*by};
      return scale * dot(gradient, d);
    };
    const Floats by_u = slope(&Linear::by_u), by_v = slope(&Linear::by_v);
    const Floats steepness = 1 / square_root(at_least(1e-30f, by_u * by_u + by_v * by_v));
    // The contour bends as the centreline does, seen on the skin's normal: a parabola's mean height in the
    // pixel.
    const Floats bent = 1 + k * h,
                 along_ray = (k * near.z * ray.direction.x + (1 - k * near.x) * ray.direction.z) / bent;
    const Floats across = at_least(0.1f, 1 - along_ray * along_ray / dot(ray.direction, ray.direction));
    const Floats bending = -k * h / (radius * bent * steepness * across);
    const Floats normal_u = -by_u * steepness, normal_v = -by_v * steepness;
    const Floats widest = larger(normal_u * normal_u, normal_v * normal_v);
    const SquarePart within = part_beyond(normal_u, normal_v, gap * steepness - bending / (24 * widest));
    // In the middle of what is within.
    const Mask is_some = within.area > 0;
    const RayLanes inner =
        ray_of(piece, u + choose(is_some, within.x, Floats{}), v + choose(is_some, within.y, Floats{}));
    const Floats inner_t = entry_of(inner, square, lowest_of<3>(inner, square));
    const Vector p = along(inner.point, inner.direction, inner_t);
    Mask is_simple = gap == gap;
    for (std::size_t j = 0; j < piece.edge_count; ++j) {
      const SpanEdge& edge = piece.edges[j];
      const Floats off = dot(p, edge.normal) - edge.offset;
      is_simple &= (off > edge.far) | (off < -edge.far);
    }
    Floats light[3];
    skin_light<false>(piece, inner, inner.depth + inner_t, p, normal_of(piece, inner, p, inner_t), light);
    store(borders.coverage + i, within.area);
    for (std::size_t c = 0; c < piece.channels; ++c) store(borders.light + c * span_step + i, light[c]);
    const Floats entry = ray.depth + entry_of(ray, square, lowest);
    store(borders.depth + i, choose(gap < 0, entry, Floats{} + __builtin_inff()));
    store(borders.contour + i, contour);
    const std::uint32_t simple = bits_of(is_simple);
    for (std::size_t j = 0; j < lanes; ++j)
      borders.is_simple[i + j] = static_cast<std::uint8_t>(simple >> j & 1);
  }
}

// Points evenly spread over the pixel: a lattice of the golden ratio. Colours differ by more than their
// grays.
constexpr std::size_t gray_samples = 64, color_samples = 256;

// The sums go by the points' numbers modulo span_step, so that the width does not change their order.
void sample(const SpanPiece& piece, float u, float v, float* light) {
  const float square = piece.radius * piece.radius;
  const std::size_t count = piece.channels == 1 ? gray_samples : color_samples;
  float sums[4][span_step] = {};
  for (std::size_t i = 0; i < count; i += lanes) {
    const std::size_t slot = i % span_step;
    const Floats number = counted() + static_cast<float>(i);
    const Floats turns = number * 0.618034f;
    Floats part = turns;
    for (std::size_t j = 0; j < lanes; ++j)
      part[j] = turns[j] - static_cast<float>(static_cast<int>(turns[j]));
    const Floats x = (number + 0.5f) / static_cast<float>(count) - 0.5f;
    const RayLanes ray = ray_of(piece, x + (u - piece.u0), part - 0.5f + (v - piece.v0));
    const Lowest lowest = lowest_of<3>(ray, square);
    const Mask is_inside = lowest.value < 0;
    const Floats t = entry_of(ray, square, lowest);
    const Vector p = along(ray.point, ray.direction, t);
    Floats here[3];
    skin_light<false>(piece, ray, ray.depth + t, p, normal_of(piece, ray, p, t), here);
    for (std::size_t c = 0; c < piece.channels; ++c)
      store(sums[c] + slot, load(sums[c] + slot) + choose(is_inside, here[c], Floats{}));
    store(sums[3] + slot, load(sums[3] + slot) + choose(is_inside, Floats{} + 1, Floats{}));
  }
  float totals[4] = {};
  for (std::size_t c = 0; c < 4; ++c)
    for (const float sum : sums[c]) totals[c] += sum;
  if (totals[3] == 0) return;
  for (std::size_t c = 0; c < piece.channels; ++c) light[c] = totals[c] / totals[3];
}

void plane(float scale, float value, float by_u, float* depth, std::size_t count) {
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const Floats u = counted() + static_cast<float>(i);
    store(depth + i, scale / (value + by_u * u));
  }
  for (; i < count; ++i) depth[i] = scale / (value + by_u * static_cast<float>(i));
}

constexpr SpanKernels span_kernels = {draw, divide, sample, plane};

}  // namespace
}  // namespace flexura
