#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "flexura/render/border.h"
#include "flexura/render/ray.h"
#include "flexura/render/tube.h"

namespace flexura {

/// A part of a tube that turns by no more than 30 degrees, or a ball at a tube's end, as rays from the camera
/// meet it. docs/renderer.md has the equations.
///
/// Its own frame P: origin at the start of its centreline, z along the tangent, x towards the centre of
/// curvature. It owns the part of space between the planes perpendicular to its centreline at its two ends;
/// what is beyond belongs to the neighbour.
struct TubePiece {
  Eigen::Matrix3d R_CP = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_CP = Eigen::Vector3d::Zero();  ///< Start of the centreline, C.
  Eigen::Vector3d p_PC = Eigen::Vector3d::Zero();  ///< The camera in P.
  double curvature = 0, length = 0;                ///< 1/m, >= 0; m.
  double radius = 0, widening = 0;                 ///< At the start, m; its change by arc length.
  double s = 0;                                    ///< Arc length of its start on the whole tube, m.
  bool is_ball = false;                            ///< All within `radius` of the origin instead.
  bool is_cut_before = true, is_cut_after = true;  ///< Whether it ends at the planes (a sphere at none).
  Eigen::Vector3d end_tangent = {0, 0, 1};         ///< P.
  double end_offset = 0;                           ///< Of the end's plane along end_tangent, m.
  int before = -1, after = -1;                     ///< The pieces that go on at its ends; -1: a true end.
  int body = 0;
  Eigen::Vector3d bound_center = Eigen::Vector3d::Zero();  ///< P: of a ball that holds it,
  double bound_radius = 0;                                 ///< m,
  double near_radius = 0;    ///< m, and of one that holds all that passes near it in the image too.
  std::size_t tube_arc = 0;  ///< Where it was cut from,
  double start_in_arc = 0;   ///< m from that arc's start.

  /// Its radius at the end, and at the end where it is wider, or narrower, m.
  [[nodiscard]] double end_radius() const { return radius + widening * length; }
  [[nodiscard]] double widest() const { return std::max(radius, end_radius()); }
  [[nodiscard]] double narrowest() const { return std::min(radius, end_radius()); }
};

/// A ray in a piece's frame; `depth` is what its direction is multiplied by.
struct LocalRay {
  Eigen::Vector3d origin, direction;
  double square = 0;  ///< Of the direction.
  double cross =
      0;  ///< How fast it turns around the centre of curvature (docs/renderer.md), constant along it.
};
/// From the camera; and from any point in C in any direction.
[[nodiscard]] LocalRay local_ray(const TubePiece& piece, const Ray& ray);
[[nodiscard]] LocalRay local_ray(const TubePiece& piece, const Eigen::Vector3d& p_CQ,
                                 const Eigen::Vector3d& direction_C);

/// The part of a ray between the two depths.
struct DepthRange {
  double from = 0, to = 0;
  bool leaves_before = false, leaves_after = false;  ///< At `to`, through the plane at the start, at the end.
  [[nodiscard]] bool is_empty() const { return !(from < to); }
};
/// Where the ray is in the piece's part of space and within `radius` of its bound's centre.
[[nodiscard]] DepthRange range_of(const TubePiece& piece, const LocalRay& local, double radius);

/// The square of the distance to the centreline less that of the radius, and its derivatives by depth:
/// negative inside. The second derivative leaves out what the widening adds.
struct Inside {
  double value, slope, curving;
};
[[nodiscard]] Inside inside_at(const TubePiece& piece, const LocalRay& ray, double depth);

/// A place near the piece in C.
struct TubePoint {
  double s = 0;             ///< Of the nearest point of the centreline, m from the start of the whole tube.
  double gap = 0;           ///< Signed distance to the surface (in the cross-section), m; negative inside.
  Eigen::Vector3d normal;   ///< Of the surfaces of equal gap, C, unit.
  Eigen::Vector3d outward;  ///< From the centreline, C, unit.
  Eigen::Vector3d tangent;  ///< Of the centreline, C, unit.
  double shrink = 1;        ///< 1 - curvature * distance towards the centre: length along it by arc length.
};
[[nodiscard]] TubePoint tube_point(const TubePiece& piece, const Eigen::Vector3d& p_CQ);

/// Depths at which a ray comes nearest to a piece without touching it; no more than two before it meets it.
struct NearMisses {
  std::array<double, 2> depths = {0, 0};
  int count = 0;
};
/// The depth in the range at which the ray enters the piece for the first time; infinity when it does not.
/// Adds the near misses before.
[[nodiscard]] double first_entry(const TubePiece& piece, const LocalRay& ray, const DepthRange& range,
                                 NearMisses& misses);

/// Where a ray that is inside at `depth`, on its way inwards, is deepest for the first time, in the range;
/// infinity when it still goes inwards at the range's end.
[[nodiscard]] double first_minimum(const TubePiece& piece, const LocalRay& ray, double depth,
                                   const DepthRange& range);

/// The same, but also where it goes inwards ever more slowly and then faster again: there a small step in the
/// image opens a gap. `has_entered`: `depth` is in the piece before.
[[nodiscard]] double first_slowdown(const TubePiece& piece, const LocalRay& ray, double depth,
                                    const DepthRange& range, bool has_entered);

}  // namespace flexura
