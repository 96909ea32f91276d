#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "flexura/render/border.h"
#include "flexura/render/ray.h"

namespace flexura {

/// A circle in space, in C: the rim of a tube's end or the edge of a coloured ring.
struct Circle {
  Eigen::Vector3d center, normal;  ///< Center, m; unit normal.
  Eigen::Vector3d x, y;            ///< Perpendicular unit vectors in its plane.
  double radius = 0;               ///< Radius, m; > 0.
  /// A ray of direction d meets the circle's plane at (d . by_x, d . by_y) / (d . by_z), from the center
  /// along x and y. The divisor is positive in front of the camera.
  Eigen::Vector3d by_x, by_y, by_z;
  Eigen::Vector2d narrow_way;  ///< Direction in (a, b) across which its image is narrowest.
  double steepness = 0;        ///< Bound on the derivative of CircleView::value by (a, b).
};

/// Returns the circle in the plane of the frame's x and y around its origin; with `is_turned` its normal is
/// -z.
[[nodiscard]] Circle circle_at(const Eigen::Matrix3d& R_CS, const Eigen::Vector3d& p_CS, double radius,
                               bool is_turned = false);

/// View of a circle from a ray. `value` is negative if the ray meets the disc in front of the camera, and
/// zero on the circle's image. The two borders are on opposite sides of the image, the nearer one first.
struct CircleView {
  double value = 0;
  std::array<Border, 2> borders;
};
[[nodiscard]] CircleView view_of(const Circle& circle, const Ray& ray);

/// Returns the depth at which the ray meets the plane through `point` across `normal`; empty if that is not
/// in front.
[[nodiscard]] std::optional<double> meet_plane(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                                               const Ray& ray);

/// A flat four-sided convex face, in C: corners in order around it.
struct Face {
  std::array<Eigen::Vector3d, 4> corners;
  Eigen::Vector3d normal;                ///< Unit.
  std::array<Eigen::Vector3d, 4> edges;  ///< Normals of the planes through the camera and the edges, inwards
                                         ///< if the camera sees the face's front.
  bool is_front = true;                  ///< Whether the camera is on the normal's side.
};
[[nodiscard]] Face face_of(const std::array<Eigen::Vector3d, 4>& corners);

/// Whether the ray meets the face from either side, and the two borders of the face's image nearest to the
/// ray. Inside the face these are its two nearest edges. Outside, the edge that excludes the ray by the
/// largest distance, and another one at least as far.
struct FaceView {
  bool is_hit = false;
  std::array<Border, 2> borders;
};
[[nodiscard]] FaceView view_of(const Face& face, const Ray& ray);

/// Returns the image near the ray of the straight line through p and q, given in C.
[[nodiscard]] Border line_border(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Ray& ray);

}  // namespace flexura
