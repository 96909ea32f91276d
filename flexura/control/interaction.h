#pragma once

#include <Eigen/Core>

// Derivatives of image features by their pixels (docs/control.md, eq. 18 and 19).
namespace flexura {

/// A feature, and its derivatives with respect to the coordinates of its two pixels.
struct PixelFeature {
  double value = 0;
  Eigen::RowVector4d by_pixels;  ///< Derivatives with respect to u_1, v_1, u_2, v_2.
};

/// Returns the angle from the image's +u to the direction from pixel `from` to pixel `to`, rad in (-pi, pi],
/// increasing towards +v. Throws std::domain_error if the two pixels coincide, which means that the arm
/// points at the camera.
[[nodiscard]] PixelFeature chord_angle(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

/// Moments of the image of a curve, given as a polygon. They are integrals over the image's own arc length,
/// so the correspondence of pixels to points of the arm is not needed.
struct CurveMoments {
  /// Length (px), centroid u, v (px), and central second moments uu, uv, vv divided by the length (px^2).
  Eigen::Vector<double, 6> values;
  /// Derivatives of the six values with respect to u and v of each vertex in turn.
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_pixels;
};
/// Returns the moments. Throws std::domain_error for fewer than two pixels, or a polygon of length 0.
[[nodiscard]] CurveMoments curve_moments(const Eigen::Matrix2Xd& polygon);
/// Computes the moments into `moments`, which it resizes if needed.
void curve_moments(const Eigen::Ref<const Eigen::Matrix2Xd>& polygon, CurveMoments& moments);

}  // namespace flexura
