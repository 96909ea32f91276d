#pragma once

#include <Eigen/Core>

// How features of an image change with the pixels that they are made of (docs/control.md, eq. 18 and 19).
namespace flexura {

/// A feature and its derivatives by the coordinates of the two pixels it is made of.
struct PixelFeature {
  double value = 0;
  Eigen::RowVector4d by_pixels;  ///< u_1, v_1, u_2, v_2
};

/// The angle from the image's +u to the way from pixel `from` to pixel `to`, rad in (-pi, pi], growing
/// towards +v. std::domain_error where they coincide: the arm points at the camera there.
[[nodiscard]] PixelFeature chord_angle(const Eigen::Vector2d& from, const Eigen::Vector2d& to);

/// Of the image of a curve, given as a polygon: 6 rows, all taken with respect to the image's own arc length,
/// so that they do not ask which pixel is which point of the arm.
struct CurveMoments {
  /// Length (px); centroid u, v (px); central second moments uu, uv, vv over the length (px^2).
  Eigen::Vector<double, 6> values;
  /// Of these six; the columns are u and v of each vertex in turn.
  Eigen::Matrix<double, 6, Eigen::Dynamic> by_pixels;
};
/// std::domain_error: fewer than two pixels, or no length.
[[nodiscard]] CurveMoments curve_moments(const Eigen::Matrix2Xd& polygon);
/// The same, into what is made to fit.
void curve_moments(const Eigen::Ref<const Eigen::Matrix2Xd>& polygon, CurveMoments& moments);

}  // namespace flexura
