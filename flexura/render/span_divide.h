#pragma once

#include "flexura/render/span_lanes.h"

// Pixels that contours divide; for span_*.cc alone.
namespace flexura {
namespace {

inline void store_flags(const WideMask& mask, std::uint8_t* to) {
  const std::uint32_t bits = bits_of(mask);
  for (std::size_t i = 0; i < wide_lanes; ++i) to[i] = static_cast<std::uint8_t>(bits >> i & 1);
}

// The part of the pixel within the tube's contour, from where the ray comes nearest to the centreline.
template <bool is_tapered>
[[gnu::always_inline]] inline SquarePart part_within(const SpanPiece& piece, const RayLanes<is_tapered>& ray,
                                                     const Place& place, const Lowest& lowest) {
  const auto radius = [&] {
    if constexpr (is_tapered)
      return lowest.radius;
    else
      return piece.radius;
  }();
  // Of sqrt(h^2 + y^2), which is the radius on the contour. On the centreline, which is in here where the
  // tube is a few pixels wide, there is no gradient; that is far within.
  const float least = 1e-6f * piece.radius * piece.radius;
  const Wide distance = square_root(at_least(least, lowest.value + radius * radius));
  const Wide gap = distance - radius;
  const Vector near = along(ray.point, ray.direction, lowest.t);
  const Wide k = piece.curvature;
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
  // The contour bends as the centreline does, seen on the skin's normal: a parabola's mean height in the
  // pixel.
  const Wide bent = 1 + k * h,
             along_ray = (k * near.z * ray.direction.x + (1 - k * near.x) * ray.direction.z) / bent;
  const Wide across = at_least(0.1f, 1 - along_ray * along_ray / dot(ray.direction, ray.direction));
  const Wide bending = -k * h / (radius * bent * steepness * across);
  const Wide normal_u = -by_u * steepness, normal_v = -by_v * steepness;
  return part_beyond(normal_u, normal_v,
                     gap * steepness - bending / (24 * larger_square(normal_u, normal_v)));
}

template <std::size_t channels, bool is_tapered>
void divide_pixels(const SpanPiece& piece, const SpanPlaces& places, BorderPixels& borders) {
  for (std::size_t i = 0; i < span_step; i += wide_lanes) {
    const Place place = place_of(places, i, piece.u0, piece.v0);
    const RayLanes<is_tapered> ray = ray_of<is_tapered>(piece, place);
    const Lowest lowest = lowest_of(piece, ray, piece.centering + 2);
    const SquarePart within = part_within(piece, ray, place, lowest);
    // In the middle of what is within.
    const WideMask is_some = within.area > 0;
    Place inner_place = place;
    const Wide x = choose(is_some, within.x, Wide(0)), y = choose(is_some, within.y, Wide(0));
    inner_place.u += place.u_by_u * x + place.u_by_v * y;
    inner_place.v += place.v_by_u * x + place.v_by_v * y;
    const RayLanes<is_tapered> inner = ray_of<is_tapered>(piece, inner_place);
    const Lowest inner_lowest = lowest_of(piece, inner, piece.centering + 1);
    const Entry inner_entry = entry_of(piece, inner, inner_lowest);
    const Vector p = along(inner.point, inner.direction, inner_entry.t);
    WideMask is_simple = lowest.is_sure;
    for (std::size_t j = 0; j < piece.edge_count; ++j) {
      const SpanEdge& edge = piece.edges[j];
      is_simple &= size_of(dot(p, edge.normal) - edge.offset) > edge.far;
    }
    Wide light[channels];
    skin_light<false>(piece, inner, inner_place, inner.depth + inner_entry.t, p,
                      normal_of(piece, inner, p, inner_entry.t), light);
    store(borders.coverage + i, within.area);
    for (std::size_t c = 0; c < channels; ++c) store(borders.light + c * span_step + i, light[c]);
    const Entry entry = entry_of(piece, ray, lowest);
    const WideMask is_inside = lowest.value < 0;
    store(borders.depth + i, choose(is_inside, ray.depth + entry.t, __builtin_inff()));
    store(borders.contour + i, ray.depth + lowest.t);
    store_flags(is_simple, borders.is_simple + i);
    const Wide move = choose(is_inside, size_of(entry.move), Wide(0));
    const Wide inner_move = choose(is_some, size_of(inner_entry.move), Wide(0));
    store_flags(lowest.is_sure & inner_lowest.is_sure & (larger(move, inner_move) < piece.settled),
                borders.is_sure + i);
  }
}

void divide(const SpanPiece& piece, const SpanPlaces& places, BorderPixels& borders) {
  if (piece.widening != 0)
    piece.channels == 1 ? divide_pixels<1, true>(piece, places, borders)
                        : divide_pixels<3, true>(piece, places, borders);
  else
    piece.channels == 1 ? divide_pixels<1, false>(piece, places, borders)
                        : divide_pixels<3, false>(piece, places, borders);
}

// Points evenly spread over the pixel, from its middle: a lattice of the golden ratio.
template <std::size_t count>
struct Lattice {
  float x[count], y[count];

  constexpr Lattice() : x(), y() {
    for (std::size_t i = 0; i < count; ++i) {
      const double turns = static_cast<double>(i) * 0.6180339887498949;
      x[i] = static_cast<float>((static_cast<double>(i) + 0.5) / count - 0.5);
      y[i] = static_cast<float>(turns - static_cast<double>(static_cast<int>(turns)) - 0.5);
    }
  }
};
constexpr Lattice<64> few_points;
constexpr Lattice<256> many_points;

// The sums go by the points' numbers modulo span_step, so that the width does not change their order.
template <std::size_t channels, bool is_tapered, std::size_t count>
bool sample_at(const Lattice<count>& points, const SpanPiece& piece, const SpanPlaces& places,
               std::size_t index, float* light) {
  const float u_by_u = places.u_by_u[index], u_by_v = places.u_by_v[index];
  const float v_by_u = places.v_by_u[index], v_by_v = places.v_by_v[index];
  float sums[channels + 1][span_step] = {};
  WideMask is_sure(true);
  for (std::size_t i = 0; i < count; i += wide_lanes) {
    const std::size_t slot = i % span_step;
    const Wide x = wide_load(points.x + i), y = wide_load(points.y + i);
    Place place{};
    place.u = x * u_by_u + y * u_by_v + (places.u[index] - piece.u0);
    place.v = x * v_by_u + y * v_by_v + (places.v[index] - piece.v0);
    const RayLanes<is_tapered> ray = ray_of<is_tapered>(piece, place);
    const Lowest lowest = lowest_of(piece, ray, piece.centering + 1);
    const WideMask is_inside = lowest.value < 0;
    const Entry entry = entry_of(piece, ray, lowest);
    const Wide& t = entry.t;
    is_sure &= lowest.is_sure & (~is_inside | (size_of(entry.move) < piece.settled));
    const Vector p = along(ray.point, ray.direction, t);
    Wide here[channels];
    skin_light<false>(piece, ray, place, ray.depth + t, p, normal_of(piece, ray, p, t), here);
    for (std::size_t c = 0; c < channels; ++c)
      store(sums[c] + slot, wide_load(sums[c] + slot) + choose(is_inside, here[c], Wide(0)));
    store(sums[channels] + slot, wide_load(sums[channels] + slot) + choose(is_inside, 1, Wide(0)));
  }
  float totals[channels + 1] = {};
  for (std::size_t c = 0; c <= channels; ++c)
    for (const float sum : sums[c]) totals[c] += sum;
  if (totals[channels] != 0)
    for (std::size_t c = 0; c < channels; ++c) light[c] = totals[c] / totals[channels];
  return !any(~is_sure);
}

template <std::size_t channels, bool is_tapered>
bool sample_pixel(const SpanPiece& piece, const SpanPlaces& places, std::size_t index, float* light) {
  // Colours that differ little need few points.
  bool is_faint = true;
  for (std::size_t j = 0; j < piece.edge_count; ++j)
    for (const float change : piece.edges[j].change) is_faint &= change * change < 0.15f * 0.15f;
  return is_faint ? sample_at<channels, is_tapered>(few_points, piece, places, index, light)
                  : sample_at<channels, is_tapered>(many_points, piece, places, index, light);
}

bool sample(const SpanPiece& piece, const SpanPlaces& places, std::size_t index, float* light) {
  if (piece.widening != 0)
    return piece.channels == 1 ? sample_pixel<1, true>(piece, places, index, light)
                               : sample_pixel<3, true>(piece, places, index, light);
  return piece.channels == 1 ? sample_pixel<1, false>(piece, places, index, light)
                             : sample_pixel<3, false>(piece, places, index, light);
}

}  // namespace
}  // namespace flexura
