#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace flexura {

/// How a camera maps directions to pixels: a pinhole with Brown-Conrady distortion (D. C. Brown, "Close-range
/// camera calibration", 1971; the parameters and their order are OpenCV's).
///
/// A point (x, y, z) in the camera's frame C (x right, y down, z forward, metres) has the normalized
/// coordinates a = x/z, b = y/z. With r^2 = a^2 + b^2 they are distorted to
///   a' = a (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 a b + p2 (r^2 + 2 a^2)
///   b' = b (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 b^2) + 2 p2 a b
/// and the pixel is u = fx a' + cx, v = fy b' + cy; (0, 0) is the centre of the top-left pixel.
struct Intrinsics {
  double fx = 800, fy = 800;                           ///< Focal lengths, px; > 0.
  double cx = 319.5, cy = 239.5;                       ///< Principal point, px.
  std::array<double, 5> distortion = {0, 0, 0, 0, 0};  ///< k1, k2, p1, p2, k3.

  /// Whether any coefficient is not 0.
  [[nodiscard]] bool is_distorted() const { return distortion != std::array<double, 5>{}; }
};

/// The order of the intrinsics in derivatives: fx, fy, cx, cy, k1, k2, p1, p2, k3.
inline constexpr int intrinsics_count = 9;

/// A pixel (u, v) and how it changes.
struct Projection {
  Eigen::Vector2d pixel;                                     ///< px
  Eigen::Matrix<double, 2, 3> by_point;                      ///< Along the point in C, px/m.
  Eigen::Matrix<double, 2, intrinsics_count> by_intrinsics;  ///< In the order above.
};

/// The same without what cameras are calibrated by.
struct PointProjection {
  Eigen::Vector2d pixel = {0, 0};                                              ///< px
  Eigen::Matrix<double, 2, 3> by_point = Eigen::Matrix<double, 2, 3>::Zero();  ///< px/m in C.
};

/// A lens as it stands, ready to project: intrinsics, and the field within which they are one to one.
class Lens {
 public:
  /// std::invalid_argument: a number that is not finite, a focal length that is not positive.
  explicit Lens(const Intrinsics& intrinsics);

  [[nodiscard]] const Intrinsics& intrinsics() const { return intrinsics_; }

  /// The largest radius sqrt(a^2 + b^2) up to which the radial part of the distortion grows: beyond, the
  /// polynomial folds the image over itself and no real lens is described. Infinite without distortion.
  [[nodiscard]] double largest_radius() const { return largest_radius_; }

  /// The pixel of a point in C, m; none behind the camera (z <= 0) or outside the largest radius.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_CP) const;

  /// The same with derivatives.
  [[nodiscard]] std::optional<Projection> project_with_derivatives(const Eigen::Vector3d& p_CP) const;

  /// Likewise, by the point alone: in a third of the time. False where there is none.
  [[nodiscard]] bool project_by_point(const Eigen::Vector3d& p_CP, PointProjection& result) const;

  /// The normalized coordinates (a, b) whose pixel this is, so that (a, b, 1) is the direction in C of the
  /// pixel's ray; to 1e-13 or so. None where the lens shows no direction.
  [[nodiscard]] std::optional<Eigen::Vector2d> unproject(const Eigen::Vector2d& pixel) const;

 private:
  Intrinsics intrinsics_;
  double largest_radius_;
};

}  // namespace flexura
