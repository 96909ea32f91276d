#pragma once

#include "flexura/render/span_lanes.h"

// Pixels that contours divide; only all_kernels.h includes this header.
namespace flexura {
namespace {

inline void store_flags(const WideMask& mask, std::uint8_t* to) {
  const std::uint32_t bits = bits_of(mask);
  for (std::size_t i = 0; i < wide_lanes; ++i) to[i] = static_cast<std::uint8_t>(bits >> i & 1);
}

// Returns the part of the pixel within the tube's contour, computed at the point where the ray is nearest to
// the centerline.
template <bool is_tapered>
[[gnu::always_inline]] inline SquarePart part_within(const SpanPiece& piece, const RayLanes<is_tapered>& ray,
                                                     const Place& place, const Lowest& lowest) {
  const auto radius = [&] {
    if constexpr (is_tapered)
      return lowest.radius;
    else
      return piece.radius;
  }();
  // Gradient of sqrt(h^2 + y^2), which equals the radius on the contour. On the centerline the gradient does
  // not exist; for a tube of a few pixels width the centerline is far inside the contour.
  const float least = 1e-6f * piece.radius * piece.radius;
  const Wide distance = square_root(at_least(least, lowest.value + radius * radius));
  const Wide gap = distance - radius;
  const Vector near = along(ray.point, ray.direction, lowest.t);
  const float k = piece.curvature;
  Wide h = ray.h0 + lowest.t * (ray.h1 + lowest.t * ray.h2);
  if (is_tapered) h -= 0.5f * k * (radius * radius);
  Vector gradient{h * (k * near.x - 1), near.y * (1 + k * h), h * (k * near.z)};
  if (is_tapered) {
    const Girth girth = girth_at(piece, near);
    const Wide factor = k * h * radius + distance;
    gradient.x -= factor * girth.by_x, gradient.z -= factor * girth.by_z;
  }
  const Wide scale = (ray.depth + lowest.t) / distance;
  const auto slope = [&](float Linear::* by) {
    const float d[3] = {piece.direction[0].*by, piece.direction[1].*by, piece.direction[2].*by};
    return scale * dot(gradient, d);
  };
  const auto [by_u, by_v] = by_pixel(place, slope(&Linear::by_u), slope(&Linear::by_v));
  const Wide steepness = 1 / square_root(at_least(1e-30f, by_u * by_u + by_v * by_v));
  // The contour has the curvature of the centerline, projected on the surface normal. This term is the mean
  // height of a parabola within the pixel.
  const Wide bent = 1 + k * h,
             along_ray = (k * near.z * ray.direction.x + (1 - k * near.x) * ray.direction.z) / bent;
  const Wide across = at_least(0.1f, 1 - along_ray * along_ray / dot(ray.direction, ray.direction));
  const Wide bending = -k * h / (radius * bent * steepness * across);
  const Wide normal_u = -by_u * steepness, normal_v = -by_v * steepness;
  return part_beyond(normal_u, normal_v,
                     gap * steepness - bending / (24 * larger_square(normal_u, normal_v)));
}

// Returns the position in the middle of a part of a pixel.
[[gnu::always_inline]] inline Place moved(Place place, const Wide& x, const Wide& y) {
  place.u += place.u_by_u * x + place.u_by_v * y;
  place.v += place.v_by_u * x + place.v_by_v * y;
  return place;
}

// Returns whether no edge of a ring divides the pixel.
[[gnu::always_inline]] inline WideMask is_far_from_edges(const SpanPiece& piece, const Vector& p) {
  WideMask is_far = mask_of(true);
  for (std::size_t j = 0; j < piece.edge_count; ++j)
    is_far &= size_of(dot(p, piece.edges[j].normal) - piece.edges[j].offset) > piece.edges[j].far;
  return is_far;
}

template <bool is_tapered>
void divide_pixels(const SpanPiece& piece, const SpanPlaces& places, BorderPixels& borders) {
  for (std::size_t i = 0; i < span_step; i += wide_lanes) {
    const Place place = place_of(places, i, piece.u0, piece.v0);
    const PieceView<is_tapered> piece_view = see<is_tapered>(piece, place, piece.centering + 2);
    const Lowest& lowest = piece_view.lowest;
    const SquarePart within = part_within(piece, piece_view.ray, place, lowest);
    // At the centroid of the inner part.
    const WideMask is_some = within.area > 0, is_inside = lowest.value < 0;
    const Place inner_place =
        moved(place, choose(is_some, within.x, Wide(0)), choose(is_some, within.y, Wide(0)));
    const PieceView<is_tapered> inner = see<is_tapered>(piece, inner_place, piece.centering + 1);
    Wide light[3];
    skin_light(piece, inner_place, inner, light);
    store(borders.coverage + i, within.area);
    for (std::size_t c = 0; c < 3; ++c) store(borders.light + c * span_step + i, light[c]);
    store(borders.depth + i, choose(is_inside, piece_view.depth, Wide(__builtin_inff())));
    store(borders.contour + i, piece_view.ray.depth + lowest.t);
    store_flags(lowest.is_sure & is_far_from_edges(piece, inner.p), borders.is_simple + i);
    store_flags(lowest.is_sure & inner.lowest.is_sure & (~is_inside | piece_view.is_settled) &
                    (~is_some | inner.is_settled),
                borders.is_sure + i);
  }
}

void divide(const SpanPiece& piece, const SpanPlaces& places, BorderPixels& borders) {
  piece.widening != 0 ? divide_pixels<true>(piece, places, borders)
                      : divide_pixels<false>(piece, places, borders);
}

// Points evenly distributed over the pixel, relative to its middle: a golden ratio lattice.
template <std::size_t n>
struct Lattice {
  float x[n], y[n];

  constexpr Lattice() : x(), y() {
    for (std::size_t i = 0; i < n; ++i) {
      const double turns = static_cast<double>(i) * 0.6180339887498949;
      x[i] = static_cast<float>((static_cast<double>(i) + 0.5) / n - 0.5);
      y[i] = static_cast<float>(turns - static_cast<double>(static_cast<int>(turns)) - 0.5);
    }
  }
};
constexpr Lattice<64> few_points;
constexpr Lattice<256> many_points;

// Results for a vector of rays.
struct Seen {
  WideMask is_some, is_sure;
  Wide depth, light[3];
};

// Sums the results of see(place) at the points of a pixel; returns whether all results are reliable. The
// summation is grouped by the points' numbers modulo span_step, so that its order does not depend on the
// vector width.
template <std::size_t n, typename See>
[[gnu::always_inline]] inline bool sample_points(const Lattice<n>& points, const Place& middle, See&& see,
                                                 float (&light)[3], float& count) {
  float sums[4][span_step] = {};
  WideMask is_sure = mask_of(true);
  for (std::size_t i = 0; i < n; i += wide_lanes) {
    const Seen seen = see(moved(middle, wide_load(points.x + i), wide_load(points.y + i)));
    const auto add = [&](float* sum, const Wide& value) {
      store(sum + i % span_step, wide_load(sum + i % span_step) + choose(seen.is_some, value, Wide(0)));
    };
    for (std::size_t c = 0; c < 3; ++c) add(sums[c], seen.light[c]);
    add(sums[3], Wide(1));
    is_sure &= seen.is_sure;
  }
  for (std::size_t c = 0; c < 4; ++c) {
    float total = 0;
    for (const float sum : sums[c]) total += sum;
    (c < 3 ? light[c] : count) = total;
  }
  return !any(~is_sure);
}
[[gnu::always_inline]] inline Place place_at(const SpanPlaces& places, std::size_t i, float u0, float v0) {
  return {Wide(places.u[i] - u0), Wide(places.v[i] - v0), Wide(places.u_by_u[i]),
          Wide(places.u_by_v[i]), Wide(places.v_by_u[i]), Wide(places.v_by_v[i])};
}

template <bool is_tapered, std::size_t n>
bool sample_skin(const Lattice<n>& points, const SpanPiece& piece, const Place& middle, float* light) {
  float sums[3], count = 0;
  const bool is_sure = sample_points(
      points, middle,
      [&](const Place& place) __attribute__((always_inline)) {
        const PieceView<is_tapered> piece_view = see<is_tapered>(piece, place, piece.centering + 1);
        Seen seen;
        seen.is_some = piece_view.lowest.value < 0;
        seen.is_sure = piece_view.lowest.is_sure & (~seen.is_some | piece_view.is_settled);
        skin_light(piece, place, piece_view, seen.light);
        return seen;
      },
      sums, count);
  if (count != 0)
    for (std::size_t c = 0; c < 3; ++c) light[c] = sums[c] / count;
  return is_sure;
}

bool sample(const SpanPiece& piece, const SpanPlaces& places, std::size_t index, float* light) {
  // Few points suffice for small differences of colour.
  bool is_faint = true;
  for (std::size_t j = 0; j < piece.edge_count; ++j)
    for (const float change : piece.edges[j].change) is_faint &= change * change < 0.15f * 0.15f;
  const Place middle = place_at(places, index, piece.u0, piece.v0);
  if (piece.widening != 0)
    return is_faint ? sample_skin<true>(few_points, piece, middle, light)
                    : sample_skin<true>(many_points, piece, middle, light);
  return is_faint ? sample_skin<false>(few_points, piece, middle, light)
                  : sample_skin<false>(many_points, piece, middle, light);
}

}  // namespace
}  // namespace flexura
