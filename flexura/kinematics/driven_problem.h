#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/model/arm_model.h"

namespace flexura {

/// Variables of inverse kinematics for an arm whose drives bend several arcs at once: commands, while targets
/// are for shapes.
class DrivenVariables {
 public:
  explicit DrivenVariables(const ArmModel& model);

  /// driven() returns the variables of commands, shaped() those of shapes.
  [[nodiscard]] const ArmVariables& driven() const { return driven_; }
  [[nodiscard]] const ArmVariables& shaped() const { return shaped_; }
  /// Computes the shape's variables from a command's, into `shape`, which it resizes if needed; NaN if the
  /// command has no shape.
  void shape(const Eigen::VectorXd& command, Eigen::VectorXd& shape) const;
  /// Returns the shape's variables for a command's; NaN if the command has no shape.
  [[nodiscard]] Eigen::VectorXd shape(const Eigen::VectorXd& command) const {
    Eigen::VectorXd made;
    shape(command, made);
    return made;
  }
  /// Returns the command's variables, within their limits, with the shape nearest to the given one.
  [[nodiscard]] Eigen::VectorXd command(const Eigen::VectorXd& shape) const;
  /// Computes the derivatives of a shape's variables by a command's at that command, into `by_command`, which
  /// it resizes if needed.
  void slopes(const Eigen::VectorXd& command, Eigen::MatrixXd& by_command) const;

 private:
  Actuation actuation_;
  ArmVariables driven_, shaped_;
  Eigen::MatrixXd shares_;  // If shapes are linear in commands.
};

/// A problem of shapes as a problem of the commands that make them.
class DrivenProblem final : public BoundedProblem {
 public:
  /// Both must outlive this object.
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
