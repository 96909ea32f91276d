#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

namespace flexura {

/// Maps directions to pixels: a pinhole with Brown-Conrady distortion (D. C. Brown, "Close-range camera
/// calibration", 1971; the parameters and their order are OpenCV's).
///
/// A point (x, y, z) in the camera's frame C (x right, y down, z forward, metres) has the normalized
/// coordinates a = x/z, b = y/z. With r^2 = a^2 + b^2 they are distorted to:
///   a' = a (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 a b + p2 (r^2 + 2 a^2)
///   b' = b (1 + k1 r^2 + k2 r^4 + k3 r^6) + p1 (r^2 + 2 b^2) + 2 p2 a b
/// The pixel is u = fx a' + cx, v = fy b' + cy; (0, 0) is the centre of the top-left pixel.
struct Intrinsics {
  double fx = 800, fy = 800;                           ///< Focal lengths, px; > 0.
  double cx = 319.5, cy = 239.5;                       ///< Principal point, px.
  std::array<double, 5> distortion = {0, 0, 0, 0, 0};  ///< k1, k2, p1, p2, k3.

  /// Returns whether any coefficient is not 0.
  [[nodiscard]] bool is_distorted() const { return distortion != std::array<double, 5>{}; }
};

/// Number of intrinsics in derivatives, in the order fx, fy, cx, cy, k1, k2, p1, p2, k3.
inline constexpr int intrinsics_count = 9;

/// A pixel (u, v) and its derivatives.
struct Projection {
  Eigen::Vector2d pixel;                 ///< Pixel (u, v), px.
  Eigen::Matrix<double, 2, 3> by_point;  ///< Derivative by the point in C, px/m.
  /// Derivative by the intrinsics, in the order above.
  Eigen::Matrix<double, 2, intrinsics_count> by_intrinsics;
};

/// A pixel and its derivative by the point alone.
struct PointProjection {
  Eigen::Vector2d pixel = {0, 0};  ///< Pixel (u, v), px.
  /// Derivative by the point in C, px/m.
  Eigen::Matrix<double, 2, 3> by_point = Eigen::Matrix<double, 2, 3>::Zero();
};

/// A lens at one zoom, ready to project: intrinsics and the field within which they are one-to-one.
class Lens {
 public:
  /// Throws std::invalid_argument for a value that is not finite, or a focal length that is not positive.
  explicit Lens(const Intrinsics& intrinsics);

  [[nodiscard]] const Intrinsics& intrinsics() const { return intrinsics_; }

  /// Returns the largest radius sqrt(a^2 + b^2) up to which the radial part of the distortion grows. Beyond,
  /// the polynomial folds the image over itself and describes no real lens. Infinite without distortion.
  [[nodiscard]] double largest_radius() const { return largest_radius_; }

  /// Returns the pixel of a point in C, m; empty behind the camera (z <= 0) or outside the largest radius.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_CP) const;

  /// Returns the pixel with its derivatives.
  [[nodiscard]] std::optional<Projection> project_with_derivatives(const Eigen::Vector3d& p_CP) const;

  /// Computes the pixel with its derivative by the point alone, in a third of the time. Returns false if
  /// there is no pixel.
  [[nodiscard]] bool project_by_point(const Eigen::Vector3d& p_CP, PointProjection& result) const;

  /// Returns the normalized coordinates (a, b) of a pixel, to about 1e-13: (a, b, 1) is the direction of the
  /// pixel's ray in C. Empty where the lens's distortion maps no ray to it.
  [[nodiscard]] std::optional<Eigen::Vector2d> unproject(const Eigen::Vector2d& pixel) const;

 private:
  Intrinsics intrinsics_;
  double largest_radius_;
};

}  // namespace flexura
