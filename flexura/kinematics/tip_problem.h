#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/math/pose.h"

namespace flexura {

/// The residual of "the tip shall be there", as a function of ArmVariables' x: rows 0 to 2 the tip's distance
/// from the target in base axes over the arm's greatest length; then, in the tip's own axes, the rotation
/// vector from the wanted orientation to the tip's, rad: two rows (about x and y) when only the direction of
/// the tip's z is wanted, three for a whole rotation. `Rows` is 3, 5 or 6.
///
/// linearise() gives as orientation rows the angular velocity, not the derivative of the rotation vector e.
/// The two differ by a matrix that has e as an eigenvector with eigenvalue 1, so the gradient of |e|^2 and
/// the undamped Gauss-Newton step are the same, and the angular velocity has no singular orientation.
template <int Rows>
class TipProblem {
 public:
  static constexpr int rows = Rows;
  using Residual = Eigen::Vector<double, Rows>;
  using Jacobian = Eigen::Matrix<double, Rows, Eigen::Dynamic>;

  /// `X_BT` is the wanted pose of the tip in the base's frame; with 5 rows only its z axis counts, with 3
  /// only its position. `length` is the scale of distances, m; tolerances in m and rad.
  TipProblem(const ArmVariables& variables, const Pose& X_BT, double length, double position_tolerance,
             double angle_tolerance);

  [[nodiscard]] Eigen::Index row_count() const { return Rows; }
  /// The residual at x, and its derivatives (Rows x variables.size(), already of that size).
  void linearise(const Eigen::VectorXd& x, Residual& r, Jacobian& J);
  /// Whether a residual is within both tolerances.
  [[nodiscard]] bool is_met(const Residual& r) const;
  /// The tip's pose in the base's frame at the last x.
  [[nodiscard]] const Pose& tip() const { return tip_; }

 private:
  void chain(const Eigen::VectorXd& x);

  const ArmVariables& variables_;
  Pose X_BT_;
  double scale_;
  double position_tolerance_;
  double angle_tolerance_;
  // Of each variable: what its rate does to the end of its section, in base axes.
  Eigen::Matrix3Xd linear_;
  Eigen::Matrix3Xd angular_;
  Eigen::Matrix3Xd ends_;  // Of each section.
  Pose tip_;
};

extern template class TipProblem<3>;
extern template class TipProblem<5>;
extern template class TipProblem<6>;

}  // namespace flexura
