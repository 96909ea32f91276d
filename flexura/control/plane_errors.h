#pragma once

#include <Eigen/Core>

namespace flexura {

/// What two parallel views show of a direction e(s), rad: in the plane XOY the angle from Y towards X, in the
/// plane ZOY that from Y towards Z.
struct PlaneView {
  double alpha_1 = 0;
  double alpha_2 = 0;
};

/// The views of the direction of the angles theta and q.
[[nodiscard]] PlaneView plane_view(double theta, double q);

/// A direction as two parallel views tell it, and its error: measured less desired (docs/control.md, eq. 14).
struct PlaneError {
  double theta = 0, q = 0;      ///< Measured, rad.
  double e_theta = 0, e_q = 0;  ///< Of the angles, rad.
};

/// Whether the planes tell the way from one direction to another, each of the angles theta and q, rad: both
/// at least 10 degrees from a quarter turn of either angle, and no quarter turn of theta between them. Where
/// they do not, both pictures have to be triangulated. Azimuths are continuous along their way: the same
/// direction a whole turn on is another one.
[[nodiscard]] bool planes_tell(const Eigen::Vector2d& measured, const Eigen::Vector2d& desired);

/// Whether the one view sees go on along Y what the other one sees come back, as of one direction by noise
/// alone.
[[nodiscard]] bool planes_contradict(const PlaneView& seen);

/// With the plane errors e_1 = alpha_1 - alpha_1d and e_2 = alpha_2 - alpha_2d taken over to the angles by
/// the derivative at the measured ones, as the paper's section 2 has it:
///   e_theta = e_1,
///   e_q = cos theta / cos^2 alpha_2 cos^2 q e_2 - sin q cos q tan theta e_1.
[[nodiscard]] PlaneError plane_error(const PlaneView& measured, const PlaneView& desired);

}  // namespace flexura
