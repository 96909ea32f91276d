#pragma once

#include <Eigen/Core>

// Derivatives of image features by their pixels (docs/control.md, eq. 18 and 19).
namespace flexura {

/// A feature that is computed from two pixels, and its derivatives.
struct PixelFeature {
  double value = 0;
  Eigen::RowVector4d by_pixels;  ///< Derivatives with respect to the pixel coordinates u_1, v_1, u_2, v_2.
};

/// Returns the angle from the image's +u to the direction from pixel `from` to pixel `to`, rad in (-pi, pi],
/// increasing towards +v. Throws std::domain_error if the two pixels coincide, which means that the arm
/// points at the camera.
[[nodiscard]] PixelFeature chord_angle(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

/// Moments of the image of a curve, given as a polyline. Moments are integrals over the arc length in the
/// image. Moments do not need the correspondence between pixels and points of the arm.
struct CurveMoments {
  /// Length (px), centroid u, v (px), and central second moments uu, uv, vv, each divided by the length
  /// (px^2).
  Eigen::Vector<double, 6> values;
  /// Derivatives of the six values with respect to u and v of each vertex in turn.
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_pixels;
};
/// Returns the moments. Throws std::domain_error for fewer than two pixels, or a polyline of length 0.
[[nodiscard]] CurveMoments curve_moments(const Eigen::Matrix2Xd& polygon);
/// Computes the moments into `moments`, which it resizes if needed.
void curve_moments(const Eigen::Ref<const Eigen::Matrix2Xd>& polygon, CurveMoments& moments);

}  // namespace flexura
