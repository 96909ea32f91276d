#include "flexura/render/tracer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "flexura/render/ray.h"

namespace flexura {
namespace {

template <typename T>
const T& at(const std::vector<T>& list, std::uint32_t index) {
  return list[static_cast<std::size_t>(index)];
}

// Relative difference in depth below which two hits count as one.
constexpr double same_hit = 1e-9;

// The three nearest surfaces and all borders near a ray. Where two bodies almost coincide and a third cuts
// both, the third is the surface visible next to the first.
struct NearSurfaces {
  static constexpr std::size_t most = 12;
  std::array<Border, most> borders;
  std::size_t count = 0;
  Hit first, second, third;

  void add(const Border& border) {
    if (!(border.distance < border_reach)) return;
    if (count < most) {
      borders[count++] = border;
      return;
    }
    const auto farthest = std::ranges::max_element(borders, std::less<>{});
    if (border < *farthest) *farthest = border;
  }
  void add_all(const std::array<Border, 2>& list) {
    for (const Border& border : list) add(border);
  }
  void add_hit(double depth, Part part) {
    // Where two pieces of a tube overlap slightly, both report it.
    for (const Hit* hit : {&first, &second})
      if (std::abs(depth - hit->depth) <= same_hit * depth) return;
    if (!(depth < third.depth)) return;
    third.depth = depth;
    third.part = part;
    if (third.depth < second.depth) std::swap(second, third);
    if (second.depth < first.depth) std::swap(first, second);
  }
};

// Returns the piece that the ray enters when it leaves this piece; -1: no piece.
int piece_behind(const TubePiece& piece, const DepthRange& range) {
  if (range.leaves_after) return piece.after;
  return range.leaves_before ? piece.before : -1;
}

Border contour_at(const TubePiece& piece, const Ray& ray, double depth) {
  const TubePoint point = tube_point(piece, depth * ray.direction);
  Eigen::Vector3d slope = point.outward;
  if (piece.widening != 0) slope -= piece.widening / point.shrink * point.tangent;
  return border_of(point.gap, depth * slope.head<2>(), ray, depth);
}

// Where the taper changes at the next piece, the nearest point of the ray may be exactly there.
void add_kink_miss(const Stage& stage, const TubePiece& piece, const Ray& ray, const LocalRay& local,
                   const DepthRange& range, NearMisses& misses) {
  const int next = piece_behind(piece, range);
  if (next < 0 || misses.count == 2) return;
  const TubePiece& neighbour = stage.pieces[static_cast<std::size_t>(next)];
  if (neighbour.widening == piece.widening) return;
  const Inside here = inside_at(piece, local, range.to);
  if (here.value <= 0 || here.slope >= 0) return;
  if (inside_at(neighbour, local_ray(neighbour, ray), range.to).slope < 0) return;
  misses.depths[static_cast<std::size_t>(misses.count++)] = range.to;
}

void meet_piece(const Stage& stage, Part part, const Ray& ray, NearSurfaces& near_surfaces) {
  const TubePiece& piece = at(stage.pieces, part.index);
  const LocalRay local = local_ray(piece, ray);
  const DepthRange range = range_of(piece, local, piece.near_radius);
  if (range.is_empty()) return;
  NearMisses misses;
  const double entry = first_entry(piece, local, range, misses);
  if (entry < infinity) near_surfaces.add_hit(entry, part);
  if (entry == infinity) add_kink_miss(stage, piece, ray, local, range, misses);
  for (int i = 0; i < misses.count; ++i) {
    near_surfaces.add(contour_at(piece, ray, misses.depths[static_cast<std::size_t>(i)]));
  }
}

void meet_disc(const Stage& stage, Part part, const Ray& ray, NearSurfaces& near_surfaces) {
  const Circle& circle = at(stage.discs, part.index).circle;
  const CircleView view = view_of(circle, ray);
  if (view.value < 0 && circle.normal.dot(circle.center) < 0) {
    const auto depth = meet_plane(circle.center, circle.normal, ray);
    if (depth) near_surfaces.add_hit(*depth, part);
  }
  near_surfaces.add_all(view.borders);
}

void meet_face(const Stage& stage, Part part, const Ray& ray, NearSurfaces& near_surfaces) {
  const FacePart& face_part = at(stage.faces, part.index);
  if (!face_part.face.is_front && face_part.screen < 0) return;
  const FaceView view = view_of(face_part.face, ray);
  if (view.is_hit) {
    const auto depth = meet_plane(face_part.face.corners[0], face_part.face.normal, ray);
    if (depth) near_surfaces.add_hit(*depth, part);
  }
  near_surfaces.add_all(view.borders);
}

void meet_half_space(const Stage& stage, Part part, const Ray& ray, NearSurfaces& near_surfaces) {
  const PlanePart& plane = at(stage.planes, part.index);
  if (!(plane.normal.dot(plane.point) < 0)) return;
  const double towards = plane.normal.dot(ray.direction);
  std::optional<double> depth;
  if (towards < 0) depth = meet_plane(plane.point, plane.normal, ray);
  if (depth) near_surfaces.add_hit(*depth, part);
  near_surfaces.add(border_of(towards, plane.normal.head<2>(), ray, depth.value_or(infinity)));
}

void meet(const Stage& stage, Part part, const Ray& ray, NearSurfaces& near_surfaces) {
  switch (part.kind) {
    case Part::Kind::piece:
      meet_piece(stage, part, ray, near_surfaces);
      break;
    case Part::Kind::disc:
      meet_disc(stage, part, ray, near_surfaces);
      break;
    case Part::Kind::face:
      meet_face(stage, part, ray, near_surfaces);
      break;
    case Part::Kind::plane:
      meet_half_space(stage, part, ray, near_surfaces);
      break;
  }
}

// Returns the contour of the tube that the ray has entered, at which the ray would leave the tube if the
// pixel moved.
Border own_contour(const Stage& stage, const Ray& ray, const Hit& hit) {
  auto index = static_cast<int>(hit.part.index);
  double depth = hit.depth;
  for (int steps = 0; index >= 0 && steps < 64; ++steps) {
    const TubePiece& piece = stage.pieces[static_cast<std::size_t>(index)];
    const LocalRay local = local_ray(piece, ray);
    const DepthRange range = range_of(piece, local, piece.near_radius);
    if (range.is_empty()) break;
    const double lowest = first_slowdown(piece, local, depth, range, steps > 0);
    if (lowest < infinity) return contour_at(piece, ray, lowest);
    if (range.to <= depth) break;
    depth = range.to;
    index = piece_behind(piece, range);
    if (index >= 0) continue;
    // The ray leaves through the tube's end. If the contour meets the end's rim nearby, at an unknown angle,
    // the ray would not have reached much deeper.
    const Inside at = inside_at(piece, local, depth);
    Border corner = contour_at(piece, ray, depth);
    corner.distance *= 0.7;
    const double still_to_go = at.slope * at.slope / (2 * std::max(at.curving, 0.0));
    if (corner.distance * still_to_go < 2 * std::abs(at.value)) return corner;
  }
  return {};
}

// Whether a tube's piece emerges from the flat surface that was hit: it contains the point well inside, or
// begins at it.
bool comes_out_of(const Stage& stage, std::uint32_t index, const Hit& flat, const Eigen::Vector3d& p_CQ) {
  if (flat.part.kind == Part::Kind::disc &&
      at(stage.discs, flat.part.index).arm_piece == static_cast<int>(index))
    return true;
  const TubePiece& piece = at(stage.pieces, index);
  const Eigen::Vector3d p = piece.R_CP.transpose() * (p_CQ - piece.p_CP);
  const double margin = 1e-6 * piece.radius;
  return (p - piece.bound_center).squaredNorm() < piece.near_radius * piece.near_radius &&
         (!piece.is_cut_before || p.z() > margin) &&
         (!piece.is_cut_after || piece.end_tangent.dot(p) < piece.end_offset - margin);
}

// Angle around the etalon's +Y from its +Z of a point in C.
double etalon_angle(const Stage& stage, const Eigen::Vector3d& p_CQ) {
  const Eigen::Vector3d p = stage.X_CE.rotation.transpose() * (p_CQ - stage.X_CE.position);
  return std::atan2(p.x(), p.z());
}

SurfaceLabel skin_label(const Stage& stage, const TubePiece& piece, double s, const Eigen::Vector3d& p_CQ) {
  const Body& body = stage.bodies[static_cast<std::size_t>(piece.body)];
  if (body.is_arm) return arm_label(stage, piece, s);
  if (body.is_etalon) {
    const Etalon& etalon = *stage.scene->etalon;
    const double quarters = etalon_angle(stage, p_CQ) / (std::numbers::pi / 2);
    const double line = std::round(quarters);
    const double off = std::abs(quarters - line) * (std::numbers::pi / 2) * etalon.radius;
    if (off < 0.5 * etalon.line_width)
      return {SurfaceKind::etalon_line, static_cast<std::uint16_t>((static_cast<int>(line) + 4) % 4)};
  }
  return body.label;
}

// Computes the remaining members of a hit.
void complete(const Stage& stage, const Ray& ray, Hit& hit) {
  if (hit.is_none()) return;
  int body = 0;
  switch (hit.part.kind) {
    case Part::Kind::piece: {
      const TubePiece& piece = at(stage.pieces, hit.part.index);
      const Eigen::Vector3d p = hit.depth * ray.direction;
      const TubePoint point = tube_point(piece, p);
      hit.normal = point.normal;
      hit.label = skin_label(stage, piece, point.s, p);
      if (at(stage.bodies, static_cast<std::uint32_t>(piece.body)).is_arm) hit.s = point.s;
      if (hit.label.kind == SurfaceKind::disk) hit.s = stage.scene->arm.disks[hit.label.index].s;
      return;
    }
    case Part::Kind::disc: {
      const DiscPart& disc = at(stage.discs, hit.part.index);
      hit.normal = disc.circle.normal;
      const Body& end = at(stage.bodies, static_cast<std::uint32_t>(disc.body));
      if (end.label.kind == SurfaceKind::cap) hit.s = stage.scene->arm.tube[disc.tube_arc].s + disc.along;
      body = disc.body;
      break;
    }
    case Part::Kind::face: {
      const FacePart& face = at(stage.faces, hit.part.index);
      hit.normal = face.face.is_front ? face.face.normal : Eigen::Vector3d(-face.face.normal);
      body = face.body;
      break;
    }
    case Part::Kind::plane:
      hit.normal = at(stage.planes, hit.part.index).normal;
      body = at(stage.planes, hit.part.index).body;
      break;
  }
  hit.label = stage.bodies[static_cast<std::size_t>(body)].label;
  if (hit.label.kind == SurfaceKind::disk) hit.s = stage.scene->arm.disks[hit.label.index].s;
}

// Returns the derivative of a hit's depth with respect to (a, b).
Eigen::Vector2d depth_slope(const Hit& hit, const Ray& ray) {
  const double towards = hit.normal.dot(ray.direction);
  if (towards == 0) return {infinity, infinity};
  return hit.normal.head<2>() * (-hit.depth / towards);
}

// Returns the edge of a ring near a hit, from the derivative of s on the surface. If the circle's image
// agrees, it is used instead, as it is more exact.
Border ring_border(const RingEdge& edge, double s, const Eigen::Vector2d& s_slope, double depth,
                   const Ray& ray) {
  Border straight = border_of(s - edge.s, s_slope, ray, depth);
  if (!(straight.distance < border_reach)) return straight;
  const CircleView view = view_of(edge.circle, ray);
  for (const Border& border : view.borders) {
    const bool is_same = border.towards.dot(straight.towards) > 0.9 &&
                         std::abs(border.distance - straight.distance) < 0.2 * straight.distance + 1e-6;
    if (is_same) return {border.distance, border.towards, depth};
  }
  return straight;
}

// Returns the derivative with respect to (a, b) of a surface point's coordinate along `direction`.
Eigen::Vector2d surface_slope(const Hit& hit, const Ray& ray, const Eigen::Vector3d& direction) {
  return hit.depth * direction.head<2>() + direction.dot(ray.direction) * depth_slope(hit, ray);
}

// Adds the borders where tubes emerge from a flat surface that was hit; returns whether `other` is one of
// their pieces.
bool add_tube_borders(const Stage& stage, std::span<const Part> parts, const Ray& ray, const Hit& flat,
                      const Hit& other, NearSurfaces& near_surfaces) {
  const Eigen::Vector3d p = flat.depth * ray.direction;
  bool is_among = false;
  for (const Part part : parts) {
    if (part.kind != Part::Kind::piece || !comes_out_of(stage, part.index, flat, p)) continue;
    const TubePoint point = tube_point(at(stage.pieces, part.index), p);
    near_surfaces.add(border_of(point.gap, surface_slope(flat, ray, point.normal), ray, flat.depth));
    is_among = is_among || other.part == part;
  }
  return is_among;
}

// Adds colour edges on the tube near the hit.
void add_color_edges(const Stage& stage, const Ray& ray, NearSurfaces& near_surfaces) {
  const Hit& hit = near_surfaces.first;
  const TubePiece& piece = at(stage.pieces, hit.part.index);
  const Body& body = stage.bodies[static_cast<std::size_t>(piece.body)];
  if (body.is_arm) {
    const auto& edges = stage.ring_edges;
    const auto next = std::ranges::lower_bound(edges, hit.s, {}, &RingEdge::s) - edges.begin();
    const auto last = std::min(next + 3, static_cast<std::ptrdiff_t>(edges.size()));
    const TubePoint point = tube_point(piece, hit.depth * ray.direction);
    const Eigen::Vector2d slope = surface_slope(hit, ray, point.tangent) / point.shrink;
    if (!slope.allFinite()) return;
    for (auto i = std::max<std::ptrdiff_t>(next - 3, 0); i < last; ++i) {
      const RingEdge& edge = edges[static_cast<std::size_t>(i)];
      if (!edge.is_disk) {
        Border border = ring_border(edge, hit.s, slope, hit.depth, ray);
        border.is_ring = true;
        near_surfaces.add(border);
        continue;
      }
      const Eigen::Vector3d off = hit.depth * ray.direction - edge.circle.center;
      near_surfaces.add(border_of(edge.circle.normal.dot(off), surface_slope(hit, ray, edge.circle.normal),
                                  ray, hit.depth));
    }
  }
  if (body.is_etalon) {
    const double angle = etalon_angle(stage, hit.depth * ray.direction);
    for (const LineEdge& edge : stage.line_edges) {
      const double apart = std::abs(edge.angle - angle);
      if (std::min(apart, 2 * std::numbers::pi - apart) < 1.2)
        near_surfaces.add(line_border(edge.from, edge.to, ray));
    }
  }
}

// Keeps the two nearest borders that the visible surface does not hide.
void choose(const NearSurfaces& near_surfaces, const Ray& ray, Trace& trace) {
  const double slope =
      trace.hit.is_none() ? 0 : (ray.by_pixel.transpose() * depth_slope(trace.hit, ray)).norm();
  const auto is_same = [](const Border& a, const Border& b) {
    return std::abs(a.distance - b.distance) < 2e-3 && a.towards.dot(b.towards) > 0.999;
  };
  for (std::size_t i = 0; i < near_surfaces.count; ++i) {
    const Border& border = near_surfaces.borders[i];
    // The surface's depth changes differently at the border.
    const double margin = 1e-6 * trace.hit.depth + 4 * slope * (1 + border.distance);
    if (!(border.depth <= trace.hit.depth + margin)) continue;
    if (!border.is_ring) trace.clear = std::min(trace.clear, border.distance);
    if (border < trace.nearest) {
      if (!is_same(border, trace.nearest)) trace.second = trace.nearest;
      trace.nearest = border;
    } else if (border < trace.second && !is_same(border, trace.nearest)) {
      trace.second = border;
    }
  }
}

// Adds the border between the first surface and the one behind it, if any, and the tubes that emerge from it.
void add_meeting(const Stage& stage, std::span<const Part> parts, const Ray& ray, const Hit& first,
                 const Hit& other, NearSurfaces& near_surfaces) {
  // For a tube and a flat surface, uses the tube's gap on the flat surface: it is smoother over the image
  // than the difference of depths.
  const auto is_piece = [](const Hit& hit) { return hit.part.kind == Part::Kind::piece; };
  const Hit& flat = is_piece(first) ? other : first;
  const bool is_known =
      !flat.is_none() && !is_piece(flat) &&
      add_tube_borders(stage, parts, ray, flat, is_piece(first) ? first : other, near_surfaces);
  if (is_known || other.is_none()) return;
  const Eigen::Vector2d slope = depth_slope(other, ray) - depth_slope(first, ray);
  if (slope.allFinite()) near_surfaces.add(border_of(other.depth - first.depth, slope, ray, first.depth));
}

}  // namespace

Hit Tracer::hit(const Ray& ray) const {
  NearSurfaces near_surfaces;
  for (const Part part : parts_) meet(stage_, part, ray, near_surfaces);
  complete(stage_, ray, near_surfaces.first);
  return near_surfaces.first;
}

Trace Tracer::trace(const Ray& ray) const {
  NearSurfaces near_surfaces;
  for (const Part part : parts_) meet(stage_, part, ray, near_surfaces);
  for (Hit* hit : {&near_surfaces.first, &near_surfaces.second, &near_surfaces.third})
    complete(stage_, ray, *hit);
  const Hit& first = near_surfaces.first;
  add_meeting(stage_, parts_, ray, first, near_surfaces.second, near_surfaces);
  if (!near_surfaces.third.is_none())
    add_meeting(stage_, parts_, ray, first, near_surfaces.third, near_surfaces);
  if (!first.is_none() && first.part.kind == Part::Kind::piece) {
    Border contour = own_contour(stage_, ray, first);
    contour.depth = 0;  // The surface ends at the contour, regardless of the depth found for the contour.
    near_surfaces.add(contour);
    add_color_edges(stage_, ray, near_surfaces);
  }
  Trace trace;
  trace.hit = first;
  choose(near_surfaces, ray, trace);
  return trace;
}

int Tracer::entries_into_arm(const Ray& ray, double depth) const {
  int count = 0;
  double last = -1;
  for (const Part part : parts_) {
    NearSurfaces near_surfaces;
    const auto index = static_cast<int>(part.index);
    if (part.kind == Part::Kind::piece && index >= stage_.first_arm_piece && index <= stage_.last_arm_piece)
      meet_piece(stage_, part, ray, near_surfaces);
    const bool is_end =
        part.kind == Part::Kind::disc &&
        at(stage_.bodies, static_cast<std::uint32_t>(at(stage_.discs, part.index).body)).label.kind ==
            SurfaceKind::cap;
    if (is_end) meet_disc(stage_, part, ray, near_surfaces);
    const double entry = near_surfaces.first.depth;
    if (!(entry < depth) || std::abs(entry - last) <= same_hit * entry) continue;
    last = entry;
    ++count;
  }
  return count;
}

}  // namespace flexura
