#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "flexura/render/border.h"
#include "flexura/render/ray.h"
#include "flexura/render/tube.h"

namespace flexura {

/// A piece of a tube that turns by at most 30 degrees, or a ball at a tube's end, for intersection with rays.
/// For the equations see docs/renderer.md.
///
/// The piece's frame P has its origin at the start of the centerline, z along the tangent, and x towards the
/// centre of curvature. The piece's part of space is between the planes perpendicular to the centerline at
/// both ends. The space beyond these planes belongs to the neighbouring pieces.
struct TubePiece {
  Eigen::Matrix3d R_CP = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_CP = Eigen::Vector3d::Zero();  ///< Start of the centerline, in C, m.
  Eigen::Vector3d p_PC = Eigen::Vector3d::Zero();  ///< Position of the camera in P, m.
  double curvature = 0, length = 0;                ///< Curvature, 1/m, >= 0; length, m.
  double radius = 0, widening = 0;  ///< Radius at the start, m, and change of the radius per arc length.
  double s = 0;                     ///< Arc length of the piece's start on the whole tube, m.
  bool is_ball = false;  ///< Whether the piece is a ball of `radius` around the origin of P instead.
  /// Whether the plane at the start, or the plane at the end, cuts the piece; both are false for a ball.
  bool is_cut_before = true, is_cut_after = true;
  Eigen::Vector3d end_tangent = {0, 0, 1};  ///< Unit tangent at the end, in P.
  double end_offset = 0;                    ///< Offset of the end's plane along end_tangent, m.
  int before = -1, after = -1;  ///< Neighbouring pieces at start and end; -1: the tube ends there.
  int body = 0;
  /// Center of a ball that contains the piece, in P, m.
  Eigen::Vector3d bound_center = Eigen::Vector3d::Zero();
  double bound_radius = 0;  ///< Radius of the ball, m.
  /// Radius of a ball with the same center that also contains everything near the piece in the image, m.
  double near_radius = 0;
  std::size_t tube_arc = 0;  ///< Arc of the tube from which the piece was cut.
  double start_in_arc = 0;   ///< Distance of the piece's start from this arc's start, m.

  /// Returns the radius at the end of the piece, m.
  [[nodiscard]] double end_radius() const { return radius + widening * length; }
  /// Returns the largest radius, m.
  [[nodiscard]] double widest() const { return std::max(radius, end_radius()); }
  /// Returns the smallest radius, m.
  [[nodiscard]] double narrowest() const { return std::min(radius, end_radius()); }
};

/// A ray in a piece's frame P: the points origin + depth * direction.
struct LocalRay {
  Eigen::Vector3d origin, direction;
  double square = 0;  ///< Squared length of the direction.
  /// Rate of rotation around the centre of curvature (docs/renderer.md), which is constant along the ray.
  double cross = 0;
};
/// Returns a ray from the camera in the piece's frame.
[[nodiscard]] LocalRay local_ray(const TubePiece& piece, const Ray& ray);
/// Returns the ray from a point of C in a direction of C, in the piece's frame.
[[nodiscard]] LocalRay local_ray(const TubePiece& piece, const Eigen::Vector3d& p_CQ,
                                 const Eigen::Vector3d& direction_C);

/// The part of a ray between two depths.
struct DepthRange {
  double from = 0, to = 0;
  /// Whether the ray leaves the piece's part of space at `to` through the plane at the start, or through the
  /// plane at the end.
  bool leaves_before = false, leaves_after = false;
  [[nodiscard]] bool is_empty() const { return !(from < to); }
};
/// Returns the range of depths in which the ray is in the piece's part of space and within `radius`, m, of
/// bound_center.
[[nodiscard]] DepthRange range_of(const TubePiece& piece, const LocalRay& local, double radius);

/// The squared distance from the centerline minus the squared radius, which is negative inside, and its
/// derivatives with respect to depth. The second derivative omits the contribution of the taper.
struct Inside {
  double value, slope, curving;
};
[[nodiscard]] Inside inside_at(const TubePiece& piece, const LocalRay& ray, double depth);

/// Relation of a point in C to a piece near the point.
struct TubePoint {
  double s = 0;  ///< Arc length of the nearest point of the centerline, from the start of the whole tube, m.
  double gap = 0;  ///< Signed distance from the surface, measured in the cross-section, m; negative inside.
  Eigen::Vector3d normal;   ///< Unit normal of the surface of equal gap, in C.
  Eigen::Vector3d outward;  ///< Unit direction from the centerline to the point, in C.
  Eigen::Vector3d tangent;  ///< Unit tangent of the centerline, in C.
  /// Length at the point per arc length: 1 - curvature * distance towards the centre of curvature.
  double shrink = 1;
};
[[nodiscard]] TubePoint tube_point(const TubePiece& piece, const Eigen::Vector3d& p_CQ);

/// Depths at which a ray is nearest to a piece without touching it; at most two before the ray hits the
/// piece.
struct NearMisses {
  std::array<double, 2> depths = {0, 0};
  int count = 0;
};
/// Returns the depth in the range at which the ray first enters the piece; infinity if the ray does not enter
/// the piece. Adds the near misses before this depth to `misses`.
[[nodiscard]] double first_entry(const TubePiece& piece, const LocalRay& ray, const DepthRange& range,
                                 NearMisses& misses);

/// Returns the first depth in the range at which a ray is deepest in the piece. At `depth`, the ray must be
/// inside and move inwards. Returns infinity if the ray still moves inwards at the end of the range.
[[nodiscard]] double first_minimum(const TubePiece& piece, const LocalRay& ray, double depth,
                                   const DepthRange& range);

/// Returns the depth of first_minimum(), or an earlier depth at which the ray's inward motion is slowest
/// before it becomes faster again. At such a depth, a ray through a nearby image point may leave the piece
/// and enter the piece again. `has_entered`: `depth` is in the previous piece.
[[nodiscard]] double first_slowdown(const TubePiece& piece, const LocalRay& ray, double depth,
                                    const DepthRange& range, bool has_entered);

}  // namespace flexura
