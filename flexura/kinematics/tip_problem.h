#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/math/pose.h"

namespace flexura {

/// Part of the tip's pose that the target determines. The value of an enumerator is the number of residuals.
enum class TipRows { position = 3, direction = 5, rotation = 6 };

/// Residuals of the condition that the tip is at the target, as functions of the vector x of ArmVariables.
/// Rows 0 to 2 are the tip's position minus the target's, in base axes, divided by `length`. The other rows
/// are the rotation vector from the target's orientation to the tip's, in the tip's axes, rad. A target
/// direction has two such rows (about x and y), and a target rotation has three.
///
/// The orientation rows of J in linearise() are the angular velocity, not the derivative of the rotation
/// vector e. The matrix that converts the angular velocity to this derivative has e as an eigenvector with
/// eigenvalue 1. Hence the gradient of |e|^2 and the undamped Gauss-Newton step are equal for both. The
/// angular velocity has the advantage that it has no singular orientation.
class TipProblem final : public BoundedProblem {
 public:
  /// `X_BT` is the target pose of the tip in the base's frame. TipRows::position uses only the position in
  /// `X_BT`, and TipRows::direction uses position and z axis. `length` is the scale of distances, m.
  /// Tolerances are in m and rad.
  TipProblem(TipRows rows, const ArmVariables& variables, const Pose& X_BT, double length,
             double position_tolerance, double angle_tolerance);

  [[nodiscard]] Eigen::Index row_count() const override { return static_cast<Eigen::Index>(rows_); }
  void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) override;
  /// Returns whether the residuals r are within both tolerances.
  [[nodiscard]] bool is_met(const Eigen::VectorXd& r) const override;

 private:
  void chain(const Eigen::VectorXd& x);

  TipRows rows_;
  const ArmVariables& variables_;
  Pose X_BT_;
  double scale_;
  double position_tolerance_;
  double angle_tolerance_;
  // For each variable: linear and angular velocity of its section's end per unit rate, in base axes.
  Eigen::Matrix3Xd linear_;
  Eigen::Matrix3Xd angular_;
  Eigen::Matrix3Xd ends_;  // End of each section.
  Pose tip_;
};

}  // namespace flexura
