#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "flexura/render/border.h"
#include "flexura/render/ray.h"

namespace flexura {

/// A circle in the camera's frame C: the rim of a tube's end or the edge of a coloured ring.
struct Circle {
  Eigen::Vector3d center, normal;  ///< Center, m; unit normal.
  Eigen::Vector3d x, y;            ///< Perpendicular unit vectors in the circle's plane.
  double radius = 0;               ///< Radius, m; > 0.
  /// A ray of direction d intersects the circle's plane at (d . by_x, d . by_y) / (d . by_z). These
  /// coordinates are measured from the centre along x and y, m. The divisor is positive in front of the
  /// camera.
  Eigen::Vector3d by_x, by_y, by_z;
  Eigen::Vector2d narrow_way;  ///< Direction in (a, b) along which the circle's image is narrowest.
  double steepness = 0;        ///< Bound on the derivative of CircleView::value with respect to (a, b).
};

/// Returns the circle around a frame's origin in the plane of the frame's x and y. The normal is z or, with
/// `is_turned`, -z.
[[nodiscard]] Circle circle_at(const Eigen::Matrix3d& R_CS, const Eigen::Vector3d& p_CS, double radius,
                               bool is_turned = false);

/// Relation of a ray to a circle. `value` is negative if the ray hits the disc in front of the camera, and
/// zero on the circle's image. The two borders are on opposite sides of the circle's image. The first border
/// is the nearer border.
struct CircleView {
  double value = 0;
  std::array<Border, 2> borders;
};
[[nodiscard]] CircleView view_of(const Circle& circle, const Ray& ray);

/// Returns the depth at which the ray intersects the plane through `point` perpendicular to `normal`. Returns
/// std::nullopt if the intersection is not in front of the camera.
[[nodiscard]] std::optional<double> meet_plane(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                               const Ray& ray);

/// A flat convex quadrilateral in C, with corners in order around the face.
struct Face {
  std::array<Eigen::Vector3d, 4> corners;
  Eigen::Vector3d normal;  ///< Unit normal.
  /// Normals of the planes through the camera and each edge. The normals point inwards if the camera sees the
  /// face's front.
  std::array<Eigen::Vector3d, 4> edges;
  bool is_front = true;  ///< Whether the camera is on the side to which the normal points.
};
[[nodiscard]] Face face_of(const std::array<Eigen::Vector3d, 4>& corners);

/// Relation of a ray to a face: whether the ray hits the face from either side, and two borders of the face's
/// image. Inside the image, the borders are the two nearest edges. Outside, the first border is the edge that
/// excludes the ray by the largest distance, and the second border is another edge at least as far away.
struct FaceView {
  bool is_hit = false;
  std::array<Border, 2> borders;
};
[[nodiscard]] FaceView view_of(const Face& face, const Ray& ray);

/// Returns the border, near a ray, that is the image of the straight line through p and q, both in C.
[[nodiscard]] Border line_border(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Ray& ray);

}  // namespace flexura
