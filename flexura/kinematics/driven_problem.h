#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/model/arm_model.h"

namespace flexura {

/// Variables of inverse kinematics for an arm whose sections may be several arcs. The variables describe
/// commands; targets are for shapes.
class DrivenVariables {
 public:
  explicit DrivenVariables(const ArmModel& model);

  /// Returns the variables of commands; shaped() returns the variables of shapes.
  [[nodiscard]] const ArmVariables& driven() const { return driven_; }
  [[nodiscard]] const ArmVariables& shaped() const { return shaped_; }
  /// Computes the variables of the shape for the variables of a command. Resizes `shape` if needed. The
  /// result is NaN if the arm has no equilibrium for the command.
  void shape(const Eigen::VectorXd& command, Eigen::VectorXd& shape) const;
  /// Returns the variables of the shape for the variables of a command; NaN if the arm has no equilibrium.
  [[nodiscard]] Eigen::VectorXd shape(const Eigen::VectorXd& command) const {
    Eigen::VectorXd made;
    shape(command, made);
    return made;
  }
  /// Returns the variables of the command, within their limits, whose shape is nearest to `shape`.
  [[nodiscard]] Eigen::VectorXd command(const Eigen::VectorXd& shape) const;
  /// Computes the Jacobian of the shape's variables with respect to the command's variables, at `command`.
  /// Resizes `by_command` if needed.
  void slopes(const Eigen::VectorXd& command, Eigen::MatrixXd& by_command) const;

 private:
  Actuation actuation_;
  ArmVariables driven_, shaped_;
  Eigen::MatrixXd shares_;  // Jacobian, if shapes are linear in commands.
};

/// Converts a problem in the variables of shapes to a problem in the variables of commands.
class DrivenProblem final : public BoundedProblem {
 public:
  /// Both arguments must outlive this object.
  DrivenProblem(const DrivenVariables& variables, BoundedProblem& of_shape);

  [[nodiscard]] Eigen::Index row_count() const override { return of_shape_.row_count(); }
  void linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) override;
  [[nodiscard]] bool is_met(const Eigen::VectorXd& r) const override { return of_shape_.is_met(r); }

 private:
  const DrivenVariables& variables_;
  BoundedProblem& of_shape_;
  Eigen::VectorXd shape_;
  Eigen::MatrixXd by_shape_, by_command_;
};

}  // namespace flexura
