#pragma once

#include <Eigen/Core>
#include <optional>

#include "flexura/camera/intrinsics.h"

// How features of an image change: with the motion of the camera, and with the pixels that they are made of
// (docs/control.md, eq. 16 to 19).
namespace flexura {

/// 2 x 6: the rates of a fixed point's pixel (px/s) per unit of the camera's twist [v; w] (m/s, rad/s),
/// relative to W and expressed in C. For a lens with fx = fy = 1 and no distortion the interaction matrix of
/// the literature (F. Chaumette, S. Hutchinson, "Visual servo control I", 2006, eq. 11). None where the lens
/// shows the point nowhere.
[[nodiscard]] std::optional<Eigen::Matrix<double, 2, 6>> point_interaction(const Lens& lens,
                                                                           const Eigen::Vector3d& p_CP);

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
