#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace flexura {

/// Intrinsic parameters of a pinhole camera with Brown-Conrady distortion (D. C. Brown, "Close-range camera
/// calibration", 1971). Parameters and their order are those of OpenCV.
///
/// The camera's frame C has x right, y down, z forward. A point (x, y, z) in C, m, has the normalized
/// coordinates a = x/z, b = y/z. With r^2 = a^2 + b^2 the distorted coordinates are:
///   a' = a (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 a b + p2 (r^2 + 2 a^2)
///   b' = b (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 b^2) + 2 p2 a b
/// The pixel is u = fx a' + cx, v = fy b' + cy; (0, 0) is the centre of the top-left pixel.
struct Intrinsics {
  double fx = 800, fy = 800;                           ///< Focal lengths, px; > 0.
  double cx = 319.5, cy = 239.5;                       ///< Principal point, px.
  std::array<double, 5> distortion = {0, 0, 0, 0, 0};  ///< Distortion coefficients k1, k2, p1, p2, k3.

  /// Returns whether any distortion coefficient is not 0.
  [[nodiscard]] bool is_distorted() const { return distortion != std::array<double, 5>{}; }
};

/// Number of intrinsic parameters. Derivatives have them in the order fx, fy, cx, cy, k1, k2, p1, p2, k3.
inline constexpr int intrinsics_count = 9;

/// A pixel (u, v) and its derivatives.
struct Projection {
  Eigen::Vector2d pixel;                 ///< Pixel (u, v), px.
  Eigen::Matrix<double, 2, 3> by_point;  ///< Derivative with respect to the point in C, px/m.
  /// Derivative with respect to the intrinsics, in the order of `intrinsics_count`.
  Eigen::Matrix<double, 2, intrinsics_count> by_intrinsics;
};

/// A pixel (u, v) and its derivative with respect to the point.
struct PointProjection {
  Eigen::Vector2d pixel = {0, 0};  ///< Pixel (u, v), px.
  /// Derivative with respect to the point in C, px/m.
  Eigen::Matrix<double, 2, 3> by_point = Eigen::Matrix<double, 2, 3>::Zero();
};

/// A lens at one zoom position. It projects points to pixels and pixels to rays. Its field of view is limited
/// to radii for which the distortion is one-to-one.
class Lens {
 public:
  /// Throws std::invalid_argument for a value that is not finite, or a focal length that is not positive.
  explicit Lens(const Intrinsics& intrinsics);

  [[nodiscard]] const Intrinsics& intrinsics() const { return intrinsics_; }

  /// Returns the largest radius sqrt(a^2 + b^2), in normalized coordinates, up to which the radially
  /// distorted radius increases. At larger radii, the polynomial would fold the image over itself, which no
  /// real lens does. The result is infinite if the distorted radius always increases.
  [[nodiscard]] double largest_radius() const { return largest_radius_; }

  /// Returns the pixel of a point in C, m; std::nullopt for points behind the camera (z <= 0) or outside the
  /// largest radius.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_CP) const;

  /// Returns the pixel of a point in C, m, with its derivatives; std::nullopt as for project().
  [[nodiscard]] std::optional<Projection> project_with_derivatives(const Eigen::Vector3d& p_CP) const;

  /// Computes the pixel of a point in C, m, and its derivative with respect to the point. It needs a third of
  /// the time of project_with_derivatives(). Returns false if there is no pixel.
  [[nodiscard]] bool project_by_point(const Eigen::Vector3d& p_CP, PointProjection& result) const;

  /// Returns the undistorted normalized coordinates (a, b) of a pixel, accurate to about 1e-13. (a, b, 1) is
  /// the direction of the pixel's ray in C. Returns std::nullopt if the distortion maps no ray to the pixel.
  [[nodiscard]] std::optional<Eigen::Vector2d> unproject(const Eigen::Vector2d& pixel) const;

 private:
  Intrinsics intrinsics_;
  double largest_radius_;
};

}  // namespace flexura
