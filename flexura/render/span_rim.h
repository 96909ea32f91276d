#pragma once

#include "flexura/render/span_draw.h"

// Flat ends of tubes; only all_kernels.h includes this header.
namespace flexura {
namespace {

// Intersection of a ray with the plane of the end. `value` is x^2 + y^2 - z^2, which is negative inside the
// rim.
struct RimPoint {
  Wide x, y, z, value;
};
[[gnu::always_inline]] inline RimPoint rim_point(const SpanRim& rim, const Place& place) {
  const Wide x = at(rim.x, place), y = at(rim.y, place), z = at(rim.z, place);
  return {x, y, z, x * x + y * y - z * z};
}

// Local shape of the rim's image, a conic, in a pixel. `distance`, px, is the distance of the rim from the
// middle along the gradient of `value`, positive if the middle is inside. `normal_u` and `normal_v` are the
// direction of the gradient. `bending` is the curvature, 1/px. `curving` is half the sum of the second
// derivatives of `value` along and across the gradient, 1/px^2. `flatness` is the inverse of about half the
// distance to the other side of the rim, 1/px.
struct RimLine {
  RimPoint at;
  Wide distance, normal_u, normal_v, bending, curving, flatness;
};
[[gnu::always_inline]] inline RimLine rim_line(const SpanRim& rim, const Place& place) {
  RimLine line;
  const RimPoint& at = line.at = rim_point(rim, place);
  const auto product = [&](float Linear::* a, float Linear::* b) {
    return rim.x.*a * (rim.x.*b) + rim.y.*a * (rim.y.*b) - rim.z.*a * (rim.z.*b);
  };
  const float uu = product(&Linear::by_u, &Linear::by_u), uv = product(&Linear::by_u, &Linear::by_v),
              vv = product(&Linear::by_v, &Linear::by_v);
  const auto curving = [&](const Wide& u, const Wide& v) {
    const Wide by_u = place.u_by_u * u + place.u_by_v * v, by_v = place.v_by_u * u + place.v_by_v * v;
    return uu * by_u * by_u + 2 * uv * by_u * by_v + vv * by_v * by_v;
  };
  // Half of the derivatives with respect to the undistorted position, then with respect to the pixel.
  const auto slope = [&](float Linear::* by) {
    return at.x * (rim.x.*by) + at.y * (rim.y.*by) - at.z * (rim.z.*by);
  };
  const auto [by_u, by_v] = by_pixel(place, slope(&Linear::by_u), slope(&Linear::by_v));
  const Wide steepness = square_root(by_u * by_u + by_v * by_v), scale = 1 / at_least(1e-30f, steepness);
  line.normal_u = by_u * scale, line.normal_v = by_v * scale;
  const Wide across = curving(line.normal_u, line.normal_v);
  const Wide square = steepness * steepness - across * at.value;
  const Wide there = at_least(1e-30f, square_root(at_least(0, square)));
  line.distance = -at.value / (steepness + there);
  line.bending = curving(-line.normal_v, line.normal_u) / there;
  line.curving = across + curving(-line.normal_v, line.normal_u);
  line.flatness = line.curving / there;
  return line;
}

[[gnu::always_inline]] inline Wide facing(const SpanRim& rim, const RimPoint& at) {
  return at.x * rim.facing[0] + at.y * rim.facing[1];
}

// Returns whether the tube's surface faces the camera at a point of the rim: the camera is beyond the
// surface's tangent plane.
[[gnu::always_inline]] inline WideMask is_skin_seen(const SpanRim& rim, const RimPoint& at) {
  const Wide length = square_root(at.x * at.x + at.y * at.y);
  const Wide shrunk = length - (at.x * rim.bend[0] + at.y * rim.bend[1]);
  return facing(rim, at) < -length * (rim.radius - rim.lean * (length / shrunk));
}

// Returns whether the rim may cross the pixel. For an end seen from behind, only the half of the rim with
// visible tube surface is considered.
[[gnu::always_inline]] inline WideMask is_rim(const SpanRim& rim, const Place& place) {
  constexpr float reach = 0.8f;
  const RimLine line = rim_line(rim, place);
  const RimPoint& at = line.at;
  const WideMask is_seen = facing(rim, at) < rim.margin * square_root(at.x * at.x + at.y * at.y);
  // Between two near sides of the rim the gradient may be parallel to the sides.
  const WideMask is_between = size_of(at.value) < reach * reach * line.curving;
  return ((size_of(line.distance) < reach) | is_between) & (at.z > 0) & (is_seen | mask_of(rim.is_front));
}

// Appends the columns of the row's rim pixels to row.borders.
void find_rim(const SpanRim& rim, int begin, int end, SpanRow& row) {
  for_vectors(begin, end, row.width, [&](int u, const WideMask& is_asked) __attribute__((always_inline)) {
    add_borders(is_rim(rim, place_of(row, u, rim.u0, rim.v0)) & is_asked, u, row);
  });
}

void disc(const SpanRim& of, std::size_t channels, int begin, int end, SpanRow& row) {
  const SpanRim rim = of;
  for_vectors(begin, end, row.width, [&](int u, const WideMask& is_asked) __attribute__((always_inline)) {
    const Place place = place_of(row, u, rim.u0, rim.v0);
    const RimPoint at_rim = rim_point(rim, place);
    const Wide depth = 1 / at(rim.nearness, place), before = wide_load(row.depth + u);
    const WideMask is_there =
        (at_rim.value < 0) & (at_rim.z > 0) & is_asked & ~wide_flag(row.state + u, rim.state);
    leave_edges(is_there, u, row);
    const WideMask is_drawn = is_there & (depth < before);
    if (!any(is_drawn)) return;
    const Wide light[3] = {Wide(rim.light[0]), Wide(rim.light[1]), Wide(rim.light[2])};
    store(row.depth + u, choose(is_drawn, depth, before));
    store_light(light, is_drawn, channels, row.light + static_cast<std::size_t>(u) * channels);
    set_flag(is_drawn, state_arm, row.state + u);
  });
}

}  // namespace
}  // namespace flexura
