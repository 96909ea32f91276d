#pragma once

#include "flexura/render/span_divide.h"
#include "flexura/render/span_rim.h"

// Pixels that rims divide; only all_kernels.h includes this header.
namespace flexura {
namespace {

[[gnu::always_inline]] inline Place counted_from(Place place, float u0, float v0) {
  place.u -= u0, place.v -= v0;
  return place;
}

// Computes pixels that only the rim divides: an end in front of its tube or of the background, or tube
// surface that ends at the rim. The tube's contour is far away.
template <bool is_tapered>
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
    const PieceView<is_tapered> piece_view = see<is_tapered>(piece, place, piece.centering + 1);
    const Lowest& lowest = piece_view.lowest;
    // The tube's surface is outside the rim of a visible end, and inside the rim of a hidden end. Its light
    // is computed at the centroid of its part of the pixel.
    const Wide outside = 1 - within.area, turn = -within.area / at_least(1e-6f, outside);
    const Wide factor = rim.is_front ? turn : Wide(1);
    const WideMask is_some = rim.is_front ? outside > 1e-6f : within.area > 0;
    const Place part_place = moved(place, choose(is_some, factor * within.x, Wide(0)),
                                   choose(is_some, factor * within.y, Wide(0)));
    const PieceView<is_tapered> part = see<is_tapered>(piece, part_place, piece.centering + 1);
    Wide light[3];
    skin_light(piece, part_place, part, light);
    const WideMask is_simple = part.lowest.is_sure & part.is_settled & is_far_from_edges(piece, part.p);
    const WideMask is_skin_known = ~is_some | (is_simple & piece_view.is_settled);
    const WideMask is_known = rim.is_front ? is_skin_known | ~is_skin_side : is_skin_known & is_skin_side;
    const WideMask is_plain = is_known & lowest.is_sure & (lowest.value < -gap * (2 * lowest.radius - gap)) &
                              (size_of(line.bending) < sharpest) & (size_of(line.flatness) < flattest) &
                              (line.at.z > 0);
    store_flags(is_plain, pixels.is_plain + i);
    const Wide skin_area = rim.is_front ? choose(is_skin_side, outside, Wide(0)) : within.area;
    const Wide end_area = rim.is_front ? within.area : Wide(0);
    store(pixels.share + i, skin_area + end_area);
    for (std::size_t c = 0; c < 3; ++c)
      store(pixels.light + c * span_step + i, skin_area * light[c] + end_area * rim.light[c]);
    const WideMask is_skin = rim.is_front ? is_skin_side & ~is_in_disc : is_in_disc;
    const Wide beside = choose(is_skin, piece_view.depth, Wide(__builtin_inff()));
    store(pixels.depth + i, rim.is_front ? choose(is_in_disc, 1 / at(rim.nearness, on_rim), beside) : beside);
  }
}

void divide_rim(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, RimPixels& pixels) {
  piece.widening != 0 ? divide_plain<true>(rim, piece, places, pixels)
                      : divide_plain<false>(rim, piece, places, pixels);
}

// Intersects rays with the end and its tube.
template <bool is_tapered>
[[gnu::always_inline]] inline Seen see_end(const SpanRim& rim, const SpanPiece& piece, const Place& pixel) {
  const Place on_rim = counted_from(pixel, rim.u0, rim.v0), place = counted_from(pixel, piece.u0, piece.v0);
  const RimPoint at_rim = rim_point(rim, on_rim);
  const WideMask is_disc = (at_rim.value < 0) & (at_rim.z > 0) & mask_of(rim.is_front);
  const PieceView<is_tapered> piece_view = see<is_tapered>(piece, place, piece.centering + 1);
  const Vector& p = piece_view.p;
  const Wide beyond = piece.end_sine * p.x + piece.end_cosine * p.z - piece.end_offset;
  const WideMask is_inside = piece_view.lowest.value < 0;
  Seen seen;
  skin_light(piece, place, piece_view, seen.light);
  for (std::size_t c = 0; c < 3; ++c) seen.light[c] = choose(is_disc, Wide(rim.light[c]), seen.light[c]);
  seen.is_some = is_disc | (is_inside & (rim.state == state_base ? p.z >= 0 : beyond <= 0));
  seen.is_sure = is_disc | (piece_view.lowest.is_sure & (~is_inside | piece_view.is_settled));
  seen.depth = choose(is_disc, 1 / at(rim.nearness, on_rim), piece_view.depth);
  return seen;
}

template <bool is_tapered>
bool sample_end(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, std::size_t index,
                RimPixels& pixels) {
  const Place middle = place_at(places, index, 0, 0);
  const auto see = [&](const Place& place)
                       __attribute__((always_inline)) { return see_end<is_tapered>(rim, piece, place); };
  float sums[3], count = 0;
  const bool is_sure = sample_points(many_points, middle, see, sums, count);
  constexpr std::size_t point_count = sizeof many_points.x / sizeof(float);
  constexpr auto points = static_cast<float>(point_count);
  for (std::size_t c = 0; c < 3; ++c) pixels.light[c * span_step + index] = sums[c] / points;
  pixels.share[index] = count / points;
  const Seen seen = see(middle);
  pixels.depth[index] = choose(seen.is_some, seen.depth, Wide(__builtin_inff())).low[0];
  return is_sure && !any(~seen.is_sure);
}

bool sample_rim(const SpanRim& rim, const SpanPiece& piece, const SpanPlaces& places, std::size_t index,
                RimPixels& pixels) {
  return piece.widening != 0 ? sample_end<true>(rim, piece, places, index, pixels)
                             : sample_end<false>(rim, piece, places, index, pixels);
}

}  // namespace
}  // namespace flexura
