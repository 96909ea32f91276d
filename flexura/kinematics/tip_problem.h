#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/math/pose.h"

namespace flexura {

/// Part of the tip's pose that is targeted, by its number of residuals.
enum class TipRows { position = 3, direction = 5, rotation = 6 };

/// Residual of "the tip is at the target", as a function of ArmVariables' x. Rows 0 to 2 are the tip's
/// distance from the target in base axes over the arm's greatest length. The other rows are the rotation
/// vector from the target orientation to the tip's, in the tip's axes, rad. A direction of the tip's z has
/// two rows (about x and y), a whole rotation has three.
///
/// The orientation rows of linearise() are the angular velocity, not the derivative of the rotation vector e.
/// A matrix converts one to the other; it has e as an eigenvector with eigenvalue 1. So the gradient of |e|^2
/// and the undamped Gauss-Newton step are equal, and the angular velocity has no singular orientation.
class TipProblem final : public BoundedProblem {
 public:
  /// `X_BT` is the target pose of the tip in the base's frame. A direction uses only its z axis, a position
  /// only its position. `length` is the scale of distances, m; tolerances are in m and rad.
  TipProblem(TipRows rows, const ArmVariables& variables, const Pose& X_BT, double length,
             double position_tolerance, double angle_tolerance);

  [[nodiscard]] Eigen::Index row_count() const override { return static_cast<Eigen::Index>(rows_); }
  void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) override;
  /// Returns true if a residual is within both tolerances.
  [[nodiscard]] bool is_met(const Eigen::VectorXd& r) const override;

 private:
  void chain(const Eigen::VectorXd& x);

  TipRows rows_;
  const ArmVariables& variables_;
  Pose X_BT_;
  double scale_;
  double position_tolerance_;
  double angle_tolerance_;
  // Per variable: velocity of the end of its section per unit rate, in base axes.
  Eigen::Matrix3Xd linear_;
  Eigen::Matrix3Xd angular_;
  Eigen::Matrix3Xd ends_;  // End of each section.
  Pose tip_;
};

}  // namespace flexura
