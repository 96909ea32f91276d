#include "flexura/kinematics/driven_problem.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace flexura {
namespace {

// A residual that is larger than the residual of any shape.
constexpr double far_away = 1e3;

// Returns the index of each of an arm's variables among three per section (bend_x, bend_y, stretch).
std::vector<Eigen::Index> columns_of(const ArmVariables& variables) {
  std::vector<Eigen::Index> columns(static_cast<std::size_t>(variables.size()));
  for (std::size_t i = 0; i < variables.parts().size(); ++i) {
    const ArmVariables::Part& part = variables.parts()[i];
    const auto first = 3 * static_cast<Eigen::Index>(i);
    columns[static_cast<std::size_t>(part.at)] = first;
    if (part.is_spatial) columns[static_cast<std::size_t>(part.at + 1)] = first + 1;
    if (part.is_stretchable) columns[static_cast<std::size_t>(part.stretch_at())] = first + 2;
  }
  return columns;
}

}  // namespace

DrivenVariables::DrivenVariables(const ArmModel& model)
    : actuation_(model.actuation()), driven_(model.driven()), shaped_(model.shaped()) {
  if (!actuation_.is_linear()) return;
  Eigen::MatrixXd all;
  actuation_.slopes(ArmState::straight(model.driven().sections.size()), all);
  shares_ = all(columns_of(shaped_), columns_of(driven_));
}

void DrivenVariables::shape(const Eigen::VectorXd& command, Eigen::VectorXd& shape) const {
  if (actuation_.is_linear()) {
    shape.noalias() = shares_ * command;
    return;
  }
  const ArmState made = actuation_.shape(driven_.state(command));
  const bool is_there =
      std::ranges::all_of(made.bends, [](const Eigen::Vector2d& bend) { return bend.allFinite(); });
  if (is_there)
    shaped_.pack(made, shape);
  else
    shape.setConstant(shaped_.size(), std::numeric_limits<double>::quiet_NaN());
}

Eigen::VectorXd DrivenVariables::command(const Eigen::VectorXd& shape) const {
  return driven_.pack(actuation_.command(shaped_.state(shape)));
}

void DrivenVariables::slopes(const Eigen::VectorXd& command, Eigen::MatrixXd& by_command) const {
  if (actuation_.is_linear()) {
    by_command = shares_;
    return;
  }
  Eigen::MatrixXd all;
  actuation_.slopes(driven_.state(command), all);
  by_command = all(columns_of(shaped_), columns_of(driven_));
}

DrivenProblem::DrivenProblem(const DrivenVariables& variables, BoundedProblem& of_shape)
    : variables_(variables),
      of_shape_(of_shape),
      by_shape_(Eigen::MatrixXd::Zero(of_shape.row_count(), variables.shaped().size())) {}

void DrivenProblem::linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) {
  variables_.shape(x, shape_);
  // If the arm has no equilibrium, there is no shape: the residual is far from any target.
  if (!shape_.allFinite()) {
    r.setConstant(far_away);
    J.setZero();
    return;
  }
  of_shape_.linearise(shape_, r, by_shape_);
  variables_.slopes(x, by_command_);
  if (!by_command_.allFinite()) {
    r.setConstant(far_away);
    J.setZero();
    return;
  }
  J.noalias() = by_shape_ * by_command_;
}

}  // namespace flexura
