#pragma once

#include <Eigen/Core>

namespace flexura {

/// A direction e(s) in two parallel projections, rad. The direction's angle in the plane XOY is alpha_1, from
/// Y towards X. The direction's angle in the plane ZOY is alpha_2, from Y towards Z.
struct PlaneView {
  double alpha_1 = 0;
  double alpha_2 = 0;
};

/// Returns the two projections of the direction with the angles theta and q.
[[nodiscard]] PlaneView plane_view(double theta, double q);

/// A direction measured in two parallel projections, and its error: measured minus desired (docs/control.md,
/// eq. 14).
struct PlaneError {
  double theta = 0, q = 0;      ///< Measured angles, rad.
  double e_theta = 0, e_q = 0;  ///< Errors of the angles, rad.
};

/// Returns true if the two projections determine the rotation from the direction `measured` to `desired`,
/// each given as angles theta and q, rad. Both angles of both directions must differ by at least 10 degrees
/// from pi/2 and -pi/2, and theta must not pass pi/2 or -pi/2 between the two directions. Otherwise, points
/// must be triangulated from both pictures. Theta is continuous along the arm: angles that differ by a full
/// turn count as different.
[[nodiscard]] bool planes_determine(const Eigen::Vector2d& measured, const Eigen::Vector2d& desired);

/// Returns true if the direction is towards +Y in one projection and towards -Y in the other projection.
/// Noise can cause such contradictions.
[[nodiscard]] bool planes_contradict(const PlaneView& seen);

/// Returns the errors of the angles from the plane errors e_1 = alpha_1 - alpha_1d and e_2 = alpha_2 -
/// alpha_2d. The conversion uses the derivative at the measured angles, as in the paper's section 2:
///   e_theta = e_1,   e_q = cos theta / cos^2 alpha_2 cos^2 q e_2 - sin q cos q tan theta e_1.
[[nodiscard]] PlaneError plane_error(const PlaneView& measured, const PlaneView& desired);

}  // namespace flexura
