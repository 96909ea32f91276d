#include "flexura/kinematics/driven_problem.h"

#include <cstddef>

namespace flexura {

DrivenVariables::DrivenVariables(const ArmModel& model)
    : actuation_(model.actuation()),
      driven_(model.driven()),
      shaped_(model.shaped()),
      by_command_(Eigen::MatrixXd::Zero(shaped_.size(), driven_.size())) {
  for (std::size_t arc = 0; arc < actuation_.arcs(); ++arc) {
    const ArmVariables::Part &from = driven_.parts()[actuation_.section_of()[arc]],
                             &to = shaped_.parts()[arc];
    by_command_(to.at, from.at) = actuation_.share_of(arc);
    if (to.is_spatial) by_command_(to.at + 1, from.at + 1) = actuation_.share_of(arc);
    if (to.is_stretchable) by_command_(to.stretch_at(), from.stretch_at()) = 1;
  }
}

Eigen::VectorXd DrivenVariables::command(const Eigen::VectorXd& shape) const {
  return driven_.pack(actuation_.command(shaped_.state(shape)));
}

DrivenProblem::DrivenProblem(const DrivenVariables& variables, BoundedProblem& of_shape)
    : variables_(variables),
      of_shape_(of_shape),
      by_shape_(Eigen::MatrixXd::Zero(of_shape.row_count(), variables.shaped().size())) {}

void DrivenProblem::linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) {
  shape_.noalias() = variables_.by_command() * x;
  of_shape_.linearise(shape_, r, by_shape_);
  J.noalias() = by_shape_ * variables_.by_command();
}

}  // namespace flexura
