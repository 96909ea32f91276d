#pragma once

#include <Eigen/Core>
#include <optional>

#include "flexura/camera/distortion.h"

namespace flexura {

/// Intrinsic parameters of a camera. Parameters and their order are those of OpenCV.
///
/// The camera's frame C has x right, y down, z forward. A point (x, y, z) in C, m, has the normalized
/// coordinates a = x/z, b = y/z. With r^2 = a^2 + b^2 the distorted coordinates are:
///   a' = a g + 2 p1 a b + p2 (r^2 + 2 a^2)
///   b' = b g + p1 (r^2 + 2 b^2) + 2 p2 a b
/// The radial factor g depends on the lens model:
///   brown: g = 1 + k1 r^2 + k2 r^4 + k3 r^6 (D. C. Brown, "Close-range camera calibration", 1971)
///   rational: g = (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
///   fisheye: g = t (1 + k1 t^2 + k2 t^4 + k3 t^6 + k4 t^8) / r with t = atan r; p1 = p2 = 0 (J. Kannala and
///   S. S. Brandt, "A generic camera model and calibration method", 2006)
/// The pixel is u = fx a' + cx, v = fy b' + cy; (0, 0) is the centre of the top-left pixel.
struct Intrinsics {
  double fx = 800, fy = 800;      ///< Focal lengths, px; > 0.
  double cx = 319.5, cy = 239.5;  ///< Principal point, px.
  Distortion distortion = {};     ///< Lens model and its coefficients.

  /// Returns whether the camera is no pinhole.
  [[nodiscard]] bool is_distorted() const { return !distortion.is_none(); }
  /// Returns the number of parameters of the lens model: fx, fy, cx, cy and the distortion coefficients.
  [[nodiscard]] int size() const { return 4 + static_cast<int>(distortion.size()); }
};

/// Largest number of intrinsic parameters. Derivatives have them in the order fx, fy, cx, cy, and the
/// distortion coefficients in the order of the lens model. Derivatives with respect to coefficients that the
/// model does not have are 0.
inline constexpr int intrinsics_count = 4 + static_cast<int>(Distortion::most);

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

/// A lens at one zoom position. The lens projects points to pixels and pixels to rays. The lens's field of
/// view is limited to radii for which the distortion is one-to-one, and to directions within 90 degrees of
/// the optical axis.
class Lens {
 public:
  /// Throws std::invalid_argument for a value that is not finite, or a focal length that is not positive.
  explicit Lens(const Intrinsics& intrinsics);

  [[nodiscard]] const Intrinsics& intrinsics() const { return intrinsics_; }

  /// Returns the largest radius sqrt(a^2 + b^2), in normalized coordinates, up to which the radially
  /// distorted radius increases. At larger radii, the model would fold the image over itself, which no
  /// real lens does. The result is infinite if the distorted radius always increases.
  [[nodiscard]] double largest_radius() const { return largest_radius_; }

  /// Returns the pixel of a point in C, m; std::nullopt for points behind the camera (z <= 0) or outside the
  /// largest radius.
  [[nodiscard]] std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_CP) const;

  /// Returns the pixel of a point in C, m, with its derivatives; std::nullopt as for project().
  [[nodiscard]] std::optional<Projection> project_with_derivatives(const Eigen::Vector3d& p_CP) const;

  /// Computes the pixel of a point in C, m, and its derivative with respect to the point. This function needs
  /// a third of the time of project_with_derivatives(). Returns false if there is no pixel.
  [[nodiscard]] bool project_by_point(const Eigen::Vector3d& p_CP, PointProjection& result) const;

  /// Returns the undistorted normalized coordinates (a, b) of a pixel, accurate to about 1e-13. (a, b, 1) is
  /// the direction of the pixel's ray in C. Returns std::nullopt if the distortion maps no ray to the pixel.
  [[nodiscard]] std::optional<Eigen::Vector2d> unproject(const Eigen::Vector2d& pixel) const;

 private:
  Intrinsics intrinsics_;
  double largest_radius_;
};

}  // namespace flexura
