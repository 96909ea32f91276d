#pragma once

#include "flexura/render/span_divide.h"
#include "flexura/render/span_draw.h"

// Flat ends of tubes; for span_*.cc alone.
namespace flexura {
namespace {

// How far the rays pass the rim: x^2 + y^2 - z^2, in the plane of the end.
struct RimPoint {
  Wide x, y, z, value;
};
[[gnu::always_inline]] inline RimPoint rim_point(const SpanRim& rim, const Place& place) {
  const Wide x = at(rim.x, place), y = at(rim.y, place), z = at(rim.z, place);
  return {x, y, z, x * x + y * y - z * z};
}

// Whether the rim may run through the pixel: whether its image, a conic, is met within the pixel along the
// value's gradient. Of an end that is seen from behind only the half is asked for at which the skin is seen.
[[gnu::always_inline]] inline WideMask is_rim(const SpanRim& rim, const Place& place) {
  constexpr float reach = 0.8f;
  const RimPoint at = rim_point(rim, place);
  const auto product = [&](float Linear::* a, float Linear::* b) {
    return rim.x.*a * (rim.x.*b) + rim.y.*a * (rim.y.*b) - rim.z.*a * (rim.z.*b);
  };
  // Half of the derivatives by the place, then by the pixel.
  const auto slope = [&](float Linear::* by) {
    return at.x * (rim.x.*by) + at.y * (rim.y.*by) - at.z * (rim.z.*by);
  };
  const Slope by = by_pixel(place, slope(&Linear::by_u), slope(&Linear::by_v));
  const Wide &by_u = by.by_u, &by_v = by.by_v;
  const Wide steepness = square_root(by_u * by_u + by_v * by_v), scale = 1 / at_least(1e-30f, steepness);
  const Wide step_u = (place.u_by_u * by_u + place.u_by_v * by_v) * scale,
             step_v = (place.v_by_u * by_u + place.v_by_v * by_v) * scale;
  const Wide curving = product(&Linear::by_u, &Linear::by_u) * step_u * step_u +
                       2 * product(&Linear::by_u, &Linear::by_v) * step_u * step_v +
                       product(&Linear::by_v, &Linear::by_v) * step_v * step_v;
  const Wide square = steepness * steepness - curving * at.value;
  const Wide distance = size_of(at.value) / at_least(1e-30f, steepness + square_root(at_least(0, square)));
  const WideMask is_seen =
      at.x * rim.facing[0] + at.y * rim.facing[1] < rim.margin * square_root(at.x * at.x + at.y * at.y);
  return (distance < reach) & (at.z > 0) & (is_seen | WideMask(rim.is_front));
}

// Appends the columns of the row's rim pixels to row.borders.
template <bool is_straight>
void find_rim_in(const SpanRim& rim, int begin, int end, SpanRow& row) {
  for_vectors(begin, end, row.width, [&](int u, const WideMask& is_asked) __attribute__((always_inline)) {
    add_borders(is_rim(rim, place_of<is_straight>(row, u, rim.u0, rim.v0)) & is_asked, u, row);
  });
}

void find_rim(const SpanRim& rim, int begin, int end, SpanRow& row) {
  row.lens.u == nullptr ? find_rim_in<true>(rim, begin, end, row) : find_rim_in<false>(rim, begin, end, row);
}

template <std::size_t channels, bool is_straight>
void draw_disc(const SpanRim rim, int begin, int end, SpanRow& row) {
  for_vectors(begin, end, row.width, [&](int u, const WideMask& is_asked) __attribute__((always_inline)) {
    const Place place = place_of<is_straight>(row, u, rim.u0, rim.v0);
    const RimPoint at_rim = rim_point(rim, place);
    const Wide depth = 1 / at(rim.nearness, place), before = wide_load(row.depth + u);
    const WideMask is_drawn = (at_rim.value < 0) & (at_rim.z > 0) & (depth < before) & is_asked &
                              ~has_flag(row.state + u, rim.state);
    if (!any(is_drawn)) return;
    Wide light[channels];
    for (std::size_t c = 0; c < channels; ++c) light[c] = rim.light[c];
    store(row.depth + u, choose(is_drawn, depth, before));
    store_light(light, is_drawn, row.light + static_cast<std::size_t>(u) * channels);
    set_flag(is_drawn, state_arm, row.state + u);
  });
}

void disc(const SpanRim& rim, std::size_t channels, int begin, int end, SpanRow& row) {
  const bool is_straight = row.lens.u == nullptr;
  if (channels == 1)
    is_straight ? draw_disc<1, true>(rim, begin, end, row) : draw_disc<1, false>(rim, begin, end, row);
  else
    is_straight ? draw_disc<3, true>(rim, begin, end, row) : draw_disc<3, false>(rim, begin, end, row);
}

// What of the end and of its tube the rays see.
template <std::size_t channels>
struct EndSeen {
  WideMask is_some, is_sure;
  Wide depth, light[channels];
};
template <std::size_t channels>
[[gnu::always_inline]] inline EndSeen<channels> see_end(const SpanRim& rim, const SpanPiece& piece,
                                                        const Place& pixel) {
  const auto counted_from = [&](float u0, float v0) {
    Place place = pixel;
    place.u -= u0, place.v -= v0;
    return place;
  };
  const Place on_rim = counted_from(rim.u0, rim.v0), place = counted_from(piece.u0, piece.v0);
  const RimPoint at_rim = rim_point(rim, on_rim);
  const WideMask is_disc = (at_rim.value < 0) & (at_rim.z > 0) & WideMask(rim.is_front);
  const RayLanes ray = ray_of(piece, place);
  const Lowest lowest = lowest_of(piece, ray, piece.centering + 1);
  const Entry entry = entry_of(piece, ray, lowest);
  const Vector p = along(ray.point, ray.direction, entry.t);
  const Wide beyond = piece.end_sine * p.x + piece.end_cosine * p.z - piece.end_offset;
  const WideMask is_skin = (lowest.value < 0) & (rim.state == state_base ? p.z >= 0 : beyond <= 0) & ~is_disc;
  EndSeen<channels> seen;
  const Wide depth = ray.depth + entry.t;
  skin_light<false>(piece, ray, place, depth, p, normal_of(piece, ray, p, entry.t), seen.light);
  for (std::size_t c = 0; c < channels; ++c)
    seen.light[c] = choose(is_disc, rim.light[c], choose(is_skin, seen.light[c], 0));
  seen.is_some = is_disc | is_skin;
  seen.is_sure = is_disc | (lowest.is_sure & ((lowest.value > 0) | (size_of(entry.move) < piece.settled)));
  seen.depth = choose(is_disc, 1 / at(rim.nearness, on_rim), depth);
  return seen;
}

template <std::size_t channels>
void sample_rim(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, std::size_t index,
                RimPixel& pixel) {
  const Place middle{places.u[index],      places.v[index],      places.u_by_u[index],
                     places.u_by_v[index], places.v_by_u[index], places.v_by_v[index]};
  constexpr std::size_t count = sizeof many_points.x / sizeof(float);
  Wide sums[span_step / wide_lanes][channels + 1];
  for (auto& sum : sums)
    for (Wide& channel : sum) channel = 0;
  WideMask is_sure(true);
  for (std::size_t i = 0; i < count; i += wide_lanes) {
    const Wide x = wide_load(many_points.x + i), y = wide_load(many_points.y + i);
    Place place = middle;
    place.u += x * middle.u_by_u + y * middle.u_by_v;
    place.v += x * middle.v_by_u + y * middle.v_by_v;
    const EndSeen<channels> seen = see_end<channels>(rim, piece, place);
    Wide(&sum)[channels + 1] = sums[i / wide_lanes % (span_step / wide_lanes)];
    for (std::size_t c = 0; c < channels; ++c) sum[c] += seen.light[c];
    sum[channels] += choose(seen.is_some, 1, 0);
    is_sure &= seen.is_sure;
  }
  const EndSeen<channels> seen = see_end<channels>(rim, piece, middle);
  float values[span_step];
  store(values, choose(seen.is_some, seen.depth, __builtin_inff()));
  pixel.depth = values[0];
  pixel.is_sure = !any(~(is_sure & seen.is_sure));
  for (std::size_t c = 0; c <= channels; ++c) {
    for (std::size_t j = 0; j < span_step / wide_lanes; ++j) store(values + j * wide_lanes, sums[j][c]);
    float total = 0;
    for (const float value : values) total += value;
    (c < channels ? pixel.light[c] : pixel.share) = total / static_cast<float>(count);
  }
}

void divide_rim(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, std::size_t index,
                RimPixel& pixel) {
  piece.channels == 1 ? sample_rim<1>(rim, piece, places, index, pixel)
                      : sample_rim<3>(rim, piece, places, index, pixel);
}

}  // namespace
}  // namespace flexura
