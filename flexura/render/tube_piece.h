#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "flexura/render/border.h"
#include "flexura/render/ray.h"
#include "flexura/render/tube.h"

namespace flexura {

/// A part of a tube that turns by no more than 30 degrees, or a ball at a tube's end, for intersection with
/// rays. docs/renderer.md has the equations.
///
/// Its frame P has its origin at the start of its centerline, z along the tangent, x towards the centre of
/// curvature. It owns the part of space between the planes perpendicular to its centerline at its two ends;
/// the space beyond belongs to the neighbours.
struct TubePiece {
  Eigen::Matrix3d R_CP = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_CP = Eigen::Vector3d::Zero();  ///< Start of the centerline, C.
  Eigen::Vector3d p_PC = Eigen::Vector3d::Zero();  ///< The camera in P.
  double curvature = 0, length = 0;                ///< Curvature, 1/m, >= 0; length, m.
  double radius = 0, widening = 0;                 ///< Radius at the start, m, and its change by arc length.
  double s = 0;                                    ///< Arc length of its start on the whole tube, m.
  bool is_ball = false;                            ///< Everything within `radius` of the origin instead.
  bool is_cut_before = true,
       is_cut_after = true;  ///< Whether the plane at its start, or end, cuts it (never for a ball).
  Eigen::Vector3d end_tangent = {0, 0, 1};  ///< Unit tangent at the end, P.
  double end_offset = 0;                    ///< Offset of the end's plane along end_tangent, m.
  int before = -1, after = -1;              ///< Continuing pieces at its ends; -1: a true end.
  int body = 0;
  Eigen::Vector3d bound_center = Eigen::Vector3d::Zero();  ///< Center of a ball that contains it, P.
  double bound_radius = 0;                                 ///< Radius of that ball, m.
  double near_radius = 0;    ///< Radius of a ball that also contains all that is near it in the image, m.
  std::size_t tube_arc = 0;  ///< Arc from which it was cut.
  double start_in_arc = 0;   ///< Its start, m from that arc's start.

  /// Return the radius at the end, the largest and the smallest radius, m.
  [[nodiscard]] double end_radius() const { return radius + widening * length; }
  [[nodiscard]] double widest() const { return std::max(radius, end_radius()); }
  [[nodiscard]] double narrowest() const { return std::min(radius, end_radius()); }
};

/// A ray in a piece's frame; `depth` multiplies its direction.
struct LocalRay {
  Eigen::Vector3d origin, direction;
  double square = 0;  ///< Squared length of the direction.
  /// Rate of rotation around the centre of curvature (docs/renderer.md), constant along it.
  double cross = 0;
};
/// From the camera; or from any point in C in any direction.
[[nodiscard]] LocalRay local_ray(const TubePiece& piece, const Ray& ray);
[[nodiscard]] LocalRay local_ray(const TubePiece& piece, const Eigen::Vector3d& p_CQ,
                                 const Eigen::Vector3d& direction_C);

/// The part of a ray between two depths.
struct DepthRange {
  double from = 0, to = 0;
  /// Whether it leaves at `to` through the plane at the start or at the end.
  bool leaves_before = false, leaves_after = false;
  [[nodiscard]] bool is_empty() const { return !(from < to); }
};
/// Returns where the ray is in the piece's part of space and within `radius` of its bound's centre.
[[nodiscard]] DepthRange range_of(const TubePiece& piece, const LocalRay& local, double radius);

/// The squared distance to the centerline minus the squared radius, negative inside, and its derivatives by
/// depth. The second derivative omits the contribution of the taper.
struct Inside {
  double value, slope, curving;
};
[[nodiscard]] Inside inside_at(const TubePiece& piece, const LocalRay& ray, double depth);

/// A point near the piece, in C.
struct TubePoint {
  double s = 0;    ///< Arc length of the nearest point of the centerline, m from the start of the whole tube.
  double gap = 0;  ///< Signed distance to the surface (in the cross-section), m; negative inside.
  Eigen::Vector3d normal;   ///< Unit normal of the surfaces of equal gap, C.
  Eigen::Vector3d outward;  ///< Unit direction from the centerline, C.
  Eigen::Vector3d tangent;  ///< Unit tangent of the centerline, C.
  double shrink = 1;        ///< 1 - curvature * distance towards the centre: length along it by arc length.
};
[[nodiscard]] TubePoint tube_point(const TubePiece& piece, const Eigen::Vector3d& p_CQ);

/// Depths at which a ray is nearest to a piece without touching it; at most two before it meets it.
struct NearMisses {
  std::array<double, 2> depths = {0, 0};
  int count = 0;
};
/// Returns the depth in the range at which the ray first enters the piece; infinity if it does not. Adds the
/// near misses before.
[[nodiscard]] double first_entry(const TubePiece& piece, const LocalRay& ray, const DepthRange& range,
                                 NearMisses& misses);

/// Returns the first depth in the range where a ray is deepest, if it is inside at `depth` and going inwards.
/// Infinity if it still goes inwards at the range's end.
[[nodiscard]] double first_minimum(const TubePiece& piece, const LocalRay& ray, double depth,
                                   const DepthRange& range);

/// As first_minimum, but also returns a point where the ray's inward motion slows down and speeds up again. A
/// small step in the image opens a gap there. `has_entered`: `depth` is in the previous piece.
[[nodiscard]] double first_slowdown(const TubePiece& piece, const LocalRay& ray, double depth,
                                    const DepthRange& range, bool has_entered);

}  // namespace flexura
