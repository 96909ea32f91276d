// Derivatives of an equilibrium by loads, tendons and parameters of the rod.
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "flexura/math/dense.h"
#include "flexura/mechanics/statics.h"

namespace flexura {

EquilibriumSlopes RodStatics::slopes(Slack slack) {
  if (!is_solved_) throw std::logic_error("no equilibrium was found, so there are no derivatives");
  const Eigen::Index n = chain_.size(), count = static_cast<Eigen::Index>(pulls_.size());
  chain_.balance(at_, pulls_, loads_, 1);
  chain_.place_with_columns(at_);
  if (!chain_.factor()) throw std::runtime_error("the derivative at the equilibrium is singular");
  const Eigen::MatrixXd lengths_by_q = chain_.length_slopes().transpose();
  const std::vector<RodElement>& elements = chain_.elements();
  RodElement::Columns J(6, n);
  chain_.columns_at(elements.size() - 1, elements.back().poses().size() - 1, J);
  // Velocity of the tip's origin, and a force and a moment there.
  const Eigen::Vector3d p = chain_.tip().position;
  for (Eigen::Index c = 0; c < n; ++c) J.col(c).head<3>() += J.col(c).tail<3>().cross(p);

  Eigen::MatrixXd by_tension = -chain_.pull_slopes(), by_tip = J.transpose(),
                  by_parameters = -chain_.parameter_slopes(loads_.gravity);
  // Correction of the factored derivative for friction.
  Eigen::PartialPivLU<Eigen::MatrixXd> friction;
  if (chain_.has_friction() && n > 0) {
    Eigen::MatrixXd form = chain_.friction_form(pulls_);
    chain_.solve(form);
    form.diagonal().array() += 1;
    friction.compute(form);
  }
  for (Eigen::MatrixXd* columns : {&by_tension, &by_tip, &by_parameters}) {
    chain_.solve(*columns);
    if (friction.rows() > 0) *columns = friction.solve(*columns).eval();
  }
  EquilibriumSlopes slopes;
  slopes.tensions_by_input = Eigen::MatrixXd::Identity(count, count);
  if (by_displacement_) {
    std::vector<Eigen::Index> taut;
    for (std::size_t i = 0; i < taut_.size(); ++i)
      if (pulls_[i] > 0 || slack == Slack::is_taut) taut.push_back(static_cast<Eigen::Index>(i));
    Eigen::MatrixXd give = lengths_by_q(taut, Eigen::all) * by_tension(Eigen::all, taut);
    for (std::size_t a = 0; a < taut.size(); ++a) {
      const auto at = static_cast<Eigen::Index>(a);
      give(at, at) -= compliance(static_cast<std::size_t>(taut[a]));
    }
    slopes.tensions_by_input.setZero();
    if (!taut.empty()) {
      const Eigen::MatrixXd inverse = pseudo_inverse(give);
      slopes.tensions_by_input(taut, taut) = -inverse;
      const Eigen::MatrixXd held = by_tension(Eigen::all, taut) * inverse * lengths_by_q(taut, Eigen::all);
      by_tip -= held * by_tip;
      by_parameters -= held * by_parameters;
    }
  }
  slopes.q_by_input = by_tension * slopes.tensions_by_input;
  slopes.lengths_by_input = lengths_by_q * slopes.q_by_input;
  slopes.q_by_tip = by_tip;
  slopes.tip_by_input = J * slopes.q_by_input;
  slopes.tip_by_tip = J * by_tip;
  slopes.q_by_parameters = by_parameters;
  slopes.tip_by_parameters = J * by_parameters;
  return slopes;
}

}  // namespace flexura
