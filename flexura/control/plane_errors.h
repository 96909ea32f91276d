#pragma once

#include <Eigen/Core>

namespace flexura {

/// A direction e(s) in two parallel views, rad: in the plane XOY the angle from Y towards X, in the plane ZOY
/// that from Y towards Z.
struct PlaneView {
  double alpha_1 = 0;
  double alpha_2 = 0;
};

/// Returns the views of the direction with the angles theta and q.
[[nodiscard]] PlaneView plane_view(double theta, double q);

/// A direction from two parallel views, and its error: measured minus desired (docs/control.md, eq. 14).
struct PlaneError {
  double theta = 0, q = 0;      ///< Measured, rad.
  double e_theta = 0, e_q = 0;  ///< Errors of the angles, rad.
};

/// Returns true if the planes determine the way from one direction to another, each as angles theta and q,
/// rad. Both must be at least 10 degrees from a quarter turn of either angle, with no quarter turn of theta
/// between them. Otherwise, both pictures have to be triangulated. Azimuths are continuous along their way: a
/// whole turn more is another direction.
[[nodiscard]] bool planes_determine(const Eigen::Vector2d& measured, const Eigen::Vector2d& desired);

/// Returns true if one view sees the direction along +Y and the other one along -Y, which noise may cause.
[[nodiscard]] bool planes_contradict(const PlaneView& seen);

/// Returns the errors of the angles from the plane errors e_1 = alpha_1 - alpha_1d and e_2 = alpha_2 -
/// alpha_2d. They are converted by the derivative at the measured angles, as in the paper's section 2.
///   e_theta = e_1,   e_q = cos theta / cos^2 alpha_2 cos^2 q e_2 - sin q cos q tan theta e_1.
[[nodiscard]] PlaneError plane_error(const PlaneView& measured, const PlaneView& desired);

}  // namespace flexura
