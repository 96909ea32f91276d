#pragma once

#include <Eigen/Core>

#include "flexura/kinematics/arm_variables.h"
#include "flexura/kinematics/bounded_least_squares.h"
#include "flexura/model/arm_model.h"

namespace flexura {

/// What inverse kinematics varies of an arm whose drives bend several arcs at once: commands, where questions
/// are put to shapes.
class DrivenVariables {
 public:
  explicit DrivenVariables(const ArmModel& model);

  /// Of commands, and of shapes.
  [[nodiscard]] const ArmVariables& driven() const { return driven_; }
  [[nodiscard]] const ArmVariables& shaped() const { return shaped_; }
  /// The shape's variables that a command's make, into what is made to fit; NaN where it has no shape.
  void shape(const Eigen::VectorXd& command, Eigen::VectorXd& shape) const;
  /// The same.
  [[nodiscard]] Eigen::VectorXd shape(const Eigen::VectorXd& command) const {
    Eigen::VectorXd made;
    shape(command, made);
    return made;
  }
  /// The command's, within their limits, whose shape is nearest to one of these.
  [[nodiscard]] Eigen::VectorXd command(const Eigen::VectorXd& shape) const;
  /// The derivatives of a shape's by a command's, at that: into what is made to fit.
  void slopes(const Eigen::VectorXd& command, Eigen::MatrixXd& by_command) const;

 private:
  Actuation actuation_;
  ArmVariables driven_, shaped_;
  Eigen::MatrixXd shares_;  // where shapes are linear in commands
};

/// A problem of shapes as one of the commands that make them.
class DrivenProblem final : public BoundedProblem {
 public:
  /// Both outlive it.
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
