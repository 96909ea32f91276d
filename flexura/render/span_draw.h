#pragma once

#include "flexura/render/span_lanes.h"

// Draws rows of pixels, one vector at a time; only all_kernels.h includes this header.
namespace flexura {
namespace {

[[gnu::always_inline]] inline void store_light(const Wide (&light)[3], const WideMask& mask,
                                               std::size_t channels, float* to) {
  if (channels == 1) {
    store(to, choose(mask, light[0], wide_load(to)));
    return;
  }
  float values[3][wide_lanes];
  for (std::size_t c = 0; c < 3; ++c) store(values[c], light[c]);
  for (std::uint32_t bits = bits_of(mask); bits != 0; bits &= bits - 1) {
    const auto i = static_cast<std::size_t>(__builtin_ctz(bits));
    for (std::size_t c = 0; c < 3; ++c) to[3 * i + c] = values[c][i];
  }
}

// Visits a row's pixels from `begin` to `end`, vector by vector. Calls visit(u, is_asked) with the first
// column of the vector. The last vector extends beyond `end`, or starts earlier if it would extend beyond the
// picture's row.
template <typename Visit>
[[gnu::always_inline]] inline void for_vectors(int begin, int end, int width, Visit&& visit) {
  constexpr auto step = static_cast<int>(wide_lanes);
  for (int u = begin; u < end; u += step) {
    const int from = u + step <= width ? u : width - step;
    visit(from, (counted() >= static_cast<float>(u - from)) & (counted() < static_cast<float>(end - from)));
  }
}

[[gnu::always_inline]] inline void leave(const WideMask& is_left, int u, SpanRow& row) {
  if (!any(is_left)) return;
  set_flag(is_left, state_exact, row.state + u);
  row.has_exact = true;
}

// Leaves unreliable pixels to the reference path if the piece may be visible there. The ray's point is near
// the axis; the ray hits a piece that is inclined towards the camera some radii from this point.
template <bool is_tapered>
[[gnu::always_inline]] inline void leave_lost(const SpanPiece& piece, const RayLanes<is_tapered>& ray,
                                              const WideMask& is_unsure, int u, SpanRow& row) {
  leave(is_unsure & is_within(piece, ray.point, 8 * piece.widest), u, row);
}

[[gnu::always_inline]] inline void add_borders(const WideMask& is_border, int u, SpanRow& row) {
  for (auto bits = bits_of(is_border); bits != 0; bits &= bits - 1)
    row.borders[row.border_count++] = u + __builtin_ctz(bits);
}

// Leaves pixels with a screen's edge to the reference path, because their content may be in front of the
// screen or behind it.
[[gnu::always_inline]] inline void leave_edges(const WideMask& is_there, int u, SpanRow& row) {
  if (row.has_edge) leave(is_there & wide_flag(row.state + u, state_edge), u, row);
}

// Returns whether an edge of a ring is near enough to p to divide the pixel.
[[gnu::always_inline]] inline WideMask is_at_edge(const SpanPiece& piece, const Vector& p) {
  WideMask is_at{};
  for (std::size_t i = 0; i < piece.edge_count; ++i)
    is_at |= size_of(dot(p, piece.edges[i].normal) - piece.edges[i].offset) < piece.edges[i].far;
  return is_at;
}

// `piece` is a copy that no store can change, so that constants of the row are computed once.
template <bool is_tapered>
void draw_skin(const SpanPiece piece, int begin, int end, SpanRow& row) {
  const float radius = piece.radius, reach = piece.reach;
  // Values of H at the gaps +reach, -reach and -bent_reach.
  const auto near_of = [=](auto r) { return reach * (2 * r + reach); };
  const auto inside_of = [=](auto r) { return -reach * (2 * r - reach); };
  const auto deep_of = [&](auto r) { return -piece.bent_reach * (2 * r - piece.bent_reach); };
  float *const depths = row.depth, *const lights = row.light;
  for_vectors(begin, end, row.width, [&](int u, const WideMask& is_asked) __attribute__((always_inline)) {
    const Place place = place_of(row, u, piece.u0, piece.v0);
    const RayLanes<is_tapered> ray = ray_of<is_tapered>(piece, place);
    const Lowest lowest = lowest_of(piece, ray, piece.centering);
    const auto here_radius = [&] {
      if constexpr (is_tapered)
        return lowest.radius;
      else
        return radius;
    }();
    const auto near = near_of(here_radius), inside = inside_of(here_radius), deep = deep_of(here_radius);
    const WideMask is_near = lowest.value < near;
    if (!any(is_near | ~lowest.is_sure)) return;
    const Entry entry = entry_of(piece, ray, lowest);
    const WideMask is_settled = lowest.is_sure & (size_of(entry.move) < piece.settled);
    const WideMask is_inside = lowest.value < inside;
    const WideMask is_unsure = ~is_settled & (is_inside | ~lowest.is_sure);
    const Vector p = along(ray.point, ray.direction, entry.t);
    const WideMask is_here = is_within(piece, p, overlap * radius);
    if (any(is_unsure)) leave_lost(piece, ray, is_unsure & is_asked, u, row);
    const WideMask is_border = is_near & ~is_inside & lowest.is_sure;
    if (any(is_border)) {
      // Near a joint, the ray may be outside both pieces according to each of them. Within a fifth of a pixel
      // both pieces therefore take the pixel, and pixels taken twice are left to the reference path. On an
      // inclined piece the minimum of the parabola is less accurate, so that one more step is needed.
      const float slack = overlap * radius + 0.2f * reach;
      const Height there = height(piece, ray, lowest.t);
      const Vector passing = along(ray.point, ray.direction, lowest.t - there.slope / there.curving);
      const WideMask is_passing =
          is_within(piece, passing, slack + piece.kink_before, slack + piece.kink_after);
      WideMask is_taken = is_border & is_asked & (is_passing | (is_here & (lowest.value < 0)));
      if (piece.kink_before + piece.kink_after > 0) {
        const auto inner = [=](float kink) { return kink > 0 ? -kink : slack; };
        const WideMask is_at_kink =
            is_taken & ~is_within(piece, passing, inner(piece.kink_before), inner(piece.kink_after));
        leave(is_at_kink, u, row);
        is_taken &= ~is_at_kink;
      }
      add_borders(is_taken, u, row);
    }
    const Wide depth = ray.depth + entry.t, before = wide_load(depths + u);
    const WideMask is_there = is_inside & is_settled & is_here & is_asked;
    leave_edges(is_there, u, row);
    WideMask is_drawn = is_there & (depth < before);
    if (piece.bent_reach > reach && any(is_drawn & (lowest.value >= deep))) {
      const WideMask is_bent = is_drawn & (lowest.value >= deep) & is_at_edge(piece, p);
      if (any(is_bent)) add_borders(is_bent, u, row);
      is_drawn &= ~is_bent;
    }
    if (piece.rims != 0) is_drawn &= ~wide_flag(row.state + u, piece.rims);
    if (!any(is_drawn)) return;
    Wide light[3];
    skin_light<true>(piece, ray, place, depth, p, normal_of(piece, ray, p, entry.t), light);
    store(depths + u, choose(is_drawn, depth, before));
    store_light(light, is_drawn, piece.channels, lights + static_cast<std::size_t>(u) * piece.channels);
    set_flag(is_drawn, state_arm, row.state + u);
  });
}

void draw(const SpanPiece& piece, int begin, int end, SpanRow& row) {
  piece.widening != 0 ? draw_skin<true>(piece, begin, end, row) : draw_skin<false>(piece, begin, end, row);
}

void screen(const SpanScreen& of, int begin, int end, bool is_first, SpanRow& row) {
  const SpanScreen screen = of;
  const bool is_straight = row.lens.u == nullptr;
  for_vectors(begin, end, row.width, [&](int u, const WideMask& is_asked) __attribute__((always_inline)) {
    const Place place = place_of(row, u, screen.u0, screen.v0);
    const Wide nearness = at(screen.nearness, place), depth = 1 / nearness, before = wide_load(row.depth + u);
    WideMask is_inside = (nearness > 0) & is_asked, is_edge{};
    if (!is_straight) {
      // Includes pixels whose middle is beyond the horizon of the screen's plane, because a screen that is
      // seen at a small angle ends near the horizon.
      WideMask is_around = is_asked;
      for (const Linear& edge : screen.edges) {
        const Wide in = at(edge, place);
        is_inside &= in > 1;
        is_around &= in > -1;
      }
      is_edge = is_around & ~is_inside;
    }
    // Pixels where the screen intersects the present content.
    if (!is_first) is_edge |= is_inside & (size_of(nearness - 1 / before) < screen.least_distance);
    leave(is_edge, u, row);
    const WideMask is_drawn = is_inside & ((depth < before) | mask_of(is_straight && is_first));
    store(row.depth + u, choose(is_drawn, depth, before));
    if (is_straight && is_first && screen.is_plain) return;
    const Wide x = depth * at(screen.place[0], place) - screen.middle[0],
               y = depth * at(screen.place[1], place) - screen.middle[1];
    const Wide factor = at_least(0, (1 + screen.gradient[0] * x + screen.gradient[1] * y) *
                                        (1 - 0.5f * screen.falloff * (x * x + y * y)));
    Wide light[3];
    for (std::size_t c = 0; c < 3; ++c) light[c] = screen.brightness[c] * factor;
    store_light(light, is_drawn, screen.channels, row.light + static_cast<std::size_t>(u) * screen.channels);
  });
}

}  // namespace
}  // namespace flexura
