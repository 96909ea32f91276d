#pragma once

#include "flexura/render/span_divide.h"
#include "flexura/render/span_rim.h"

// Pixels that rims divide; for span_*.cc alone.
namespace flexura {
namespace {

[[gnu::always_inline]] inline Place counted_from(Place place, float u0, float v0) {
  place.u -= u0, place.v -= v0;
  return place;
}

// The skin in the middle of a part of a pixel; whether that stands for all of the part.
template <std::size_t channels>
struct SkinPart {
  WideMask is_simple;
  Wide light[channels];
};
template <std::size_t channels, bool is_tapered>
[[gnu::always_inline]] inline SkinPart<channels> skin_part(const SpanPiece& piece, Place place, const Wide& x,
                                                           const Wide& y) {
  place.u += place.u_by_u * x + place.u_by_v * y;
  place.v += place.v_by_u * x + place.v_by_v * y;
  const RayLanes<is_tapered> ray = ray_of<is_tapered>(piece, place);
  const Lowest lowest = lowest_of(piece, ray, piece.centering + 1);
  const Entry entry = entry_of(piece, ray, lowest);
  const Vector p = along(ray.point, ray.direction, entry.t);
  SkinPart<channels> part;
  part.is_simple = lowest.is_sure & (size_of(entry.move) < piece.settled);
  for (std::size_t j = 0; j < piece.edge_count; ++j)
    part.is_simple &= size_of(dot(p, piece.edges[j].normal) - piece.edges[j].offset) > piece.edges[j].far;
  skin_light<false>(piece, ray, place, ray.depth + entry.t, p, normal_of(piece, ray, p, entry.t), part.light);
  return part;
}

// Pixels that the rim alone divides: an end in front of its skin or of what is behind the arm, or skin that
// ends there. The tube's contour is far from them.
template <std::size_t channels, bool is_tapered>
void divide_plain(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, RimPixels& pixels) {
  constexpr float sharpest = 0.2f, flattest = 0.8f;  // 1/px
  const float gap = 2 * piece.reach;                 // Nearly two pixels.
  for (std::size_t i = 0; i < span_step; i += wide_lanes) {
    const Place pixel = place_of(places, i, 0, 0);
    const Place on_rim = counted_from(pixel, rim.u0, rim.v0), place = counted_from(pixel, piece.u0, piece.v0);
    const RimLine line = rim_line(rim, on_rim);
    const SquarePart within =
        part_beyond(-line.normal_u, -line.normal_v,
                    line.bending / (24 * larger_square(line.normal_u, line.normal_v)) - line.distance);
    const WideMask is_skin_side = is_skin_seen(rim, line.at), is_in_disc = line.at.value < 0;
    const RayLanes<is_tapered> ray = ray_of<is_tapered>(piece, place);
    const Lowest lowest = lowest_of(piece, ray, piece.centering + 1);
    const Entry entry = entry_of(piece, ray, lowest);
    // The skin is beyond the rim of an end that is seen, and within that of one that is not.
    const Wide outside = 1 - within.area, turn = -within.area / at_least(1e-6f, outside);
    const Wide factor = rim.is_front ? turn : Wide(1);
    const WideMask is_some = rim.is_front ? outside > 1e-6f : within.area > 0;
    const auto toward = [&](const Wide& x) { return choose(is_some, factor * x, Wide(0)); };
    const SkinPart<channels> skin =
        skin_part<channels, is_tapered>(piece, place, toward(within.x), toward(within.y));
    const WideMask is_skin_known = ~is_some | (skin.is_simple & (size_of(entry.move) < piece.settled));
    const WideMask is_known = rim.is_front ? is_skin_known | ~is_skin_side : is_skin_known & is_skin_side;
    const WideMask is_plain = is_known & lowest.is_sure & (lowest.value < -gap * (2 * lowest.radius - gap)) &
                              (size_of(line.bending) < sharpest) & (size_of(line.flatness) < flattest) &
                              (line.at.z > 0);
    store_flags(is_plain, pixels.is_plain + i);
    const Wide skin_area = rim.is_front ? choose(is_skin_side, outside, Wide(0)) : within.area;
    const Wide end_area = rim.is_front ? within.area : Wide(0);
    store(pixels.share + i, skin_area + end_area);
    for (std::size_t c = 0; c < channels; ++c)
      store(pixels.light + c * span_step + i, skin_area * skin.light[c] + end_area * rim.light[c]);
    const Wide end_depth = 1 / at(rim.nearness, on_rim), skin_depth = ray.depth + entry.t;
    const WideMask is_skin = rim.is_front ? is_skin_side & ~is_in_disc : is_in_disc;
    const Wide beside = choose(is_skin, skin_depth, Wide(__builtin_inff()));
    store(pixels.depth + i, rim.is_front ? choose(is_in_disc, end_depth, beside) : beside);
  }
}

void divide_rim(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, RimPixels& pixels) {
  if (piece.widening != 0)
    piece.channels == 1 ? divide_plain<1, true>(rim, piece, places, pixels)
                        : divide_plain<3, true>(rim, piece, places, pixels);
  else
    piece.channels == 1 ? divide_plain<1, false>(rim, piece, places, pixels)
                        : divide_plain<3, false>(rim, piece, places, pixels);
}

// What of the end and of its tube the rays see.
template <std::size_t channels>
struct EndSeen {
  WideMask is_some, is_sure;
  Wide depth, light[channels];
};
template <std::size_t channels, bool is_tapered>
[[gnu::always_inline]] inline EndSeen<channels> see_end(const SpanRim& rim, const SpanPiece& piece,
                                                        const Place& pixel) {
  const Place on_rim = counted_from(pixel, rim.u0, rim.v0), place = counted_from(pixel, piece.u0, piece.v0);
  const RimPoint at_rim = rim_point(rim, on_rim);
  const WideMask is_disc = (at_rim.value < 0) & (at_rim.z > 0) & WideMask(rim.is_front);
  const RayLanes<is_tapered> ray = ray_of<is_tapered>(piece, place);
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

template <std::size_t channels, bool is_tapered>
bool sample_rim_at(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, std::size_t index,
                   RimPixels& pixels) {
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
    const EndSeen<channels> seen = see_end<channels, is_tapered>(rim, piece, place);
    Wide(&sum)[channels + 1] = sums[i / wide_lanes % (span_step / wide_lanes)];
    for (std::size_t c = 0; c < channels; ++c) sum[c] += seen.light[c];
    sum[channels] += choose(seen.is_some, 1, 0);
    is_sure &= seen.is_sure;
  }
  const EndSeen<channels> seen = see_end<channels, is_tapered>(rim, piece, middle);
  float values[span_step];
  store(values, choose(seen.is_some, seen.depth, __builtin_inff()));
  pixels.depth[index] = values[0];
  for (std::size_t c = 0; c <= channels; ++c) {
    for (std::size_t j = 0; j < span_step / wide_lanes; ++j) store(values + j * wide_lanes, sums[j][c]);
    float total = 0;
    for (const float value : values) total += value;
    (c < channels ? pixels.light[c * span_step + index] : pixels.share[index]) =
        total / static_cast<float>(count);
  }
  return !any(~(is_sure & seen.is_sure));
}

bool sample_rim(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, std::size_t index,
                RimPixels& pixels) {
  if (piece.widening != 0)
    return piece.channels == 1 ? sample_rim_at<1, true>(rim, piece, places, index, pixels)
                               : sample_rim_at<3, true>(rim, piece, places, index, pixels);
  return piece.channels == 1 ? sample_rim_at<1, false>(rim, piece, places, index, pixels)
                             : sample_rim_at<3, false>(rim, piece, places, index, pixels);
}

}  // namespace
}  // namespace flexura
