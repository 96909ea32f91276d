#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/math/pose.h"

namespace flexura {

/// What of the tip's pose is wanted, by the number of residuals that it makes.
enum class TipRows { position = 3, direction = 5, rotation = 6 };

/// The residual of "the tip shall be there", as a function of ArmVariables' x: rows 0 to 2 the tip's distance
/// from the target in base axes over the arm's greatest length; then, in the tip's own axes, the rotation
/// vector from the wanted orientation to the tip's, rad: two rows (about x and y) when only the direction of
/// the tip's z is wanted, three for a whole rotation.
///
/// linearise() gives as orientation rows the angular velocity, not the derivative of the rotation vector e.
/// The two differ by a matrix that has e as an eigenvector with eigenvalue 1, so the gradient of |e|^2 and
/// the undamped Gauss-Newton step are the same, and the angular velocity has no singular orientation.
class TipProblem final : public BoundedProblem {
 public:
  /// `X_BT` is the wanted pose of the tip in the base's frame; of a direction only its z axis counts, of a
  /// position only that. `length` is the scale of distances, m; tolerances in m and rad.
  TipProblem(TipRows rows, const ArmVariables& variables, const Pose& X_BT, double length,
             double position_tolerance, double angle_tolerance);

  [[nodiscard]] Eigen::Index row_count() const override { return static_cast<Eigen::Index>(rows_); }
  void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) override;
  /// Whether a residual is within both tolerances.
  [[nodiscard]] bool is_met(const Eigen::VectorXd& r) const override;

 private:
  void chain(const Eigen::VectorXd& x);

  TipRows rows_;
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

}  // namespace flexura
