#include "flexura/mechanics/rod_target_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "flexura/math/dense.h"
#include "flexura/math/so3.h"

namespace flexura {
namespace {

// Error assigned to tensions without an equilibrium, in lengths of the rod; larger than all others.
constexpr double nowhere = 1e3;

// angle / sin(angle), and its derivative by the cosine.
struct TurnFactor {
  double value, by_cosine;
};
TurnFactor turn_factor(double angle) {
  if (angle < 1e-3) return {1 + angle * angle / 6, -1.0 / 3 - 2 * angle * angle / 15};
  const double sine = std::max(std::sin(angle), 1e-6);
  return {angle / sine, (angle * std::cos(angle) - sine) / (sine * sine * sine)};
}

}  // namespace

std::optional<RodNode> node_of(const RodChain& chain, const RodPlace& place) {
  if (place.section >= chain.rod().sections.size() || !std::isfinite(place.at) || place.at < 0 ||
      place.at > 1)
    return {};
  const RodNode node = chain.node_of(place);
  const RodElement& element = chain.elements()[node.element];
  if (!(std::abs(element.part().of_section(element.grid().t[node.node]) - place.at) < 1e-9)) return {};
  return node;
}

RodTargetProblem::RodTargetProblem(RodStatics& statics, const RodTarget& target, const RodLoads& loads,
                                   std::span<const double> most, double tolerance)
    : statics_(statics),
      target_(target),
      loads_(loads),
      most_(most.begin(), most.end()),
      length_(statics.chain().rod().length()),
      tolerance_(tolerance / length_),
      columns_(6, statics.chain().size()),
      twist_(6, static_cast<Eigen::Index>(most.size())) {
  const std::vector<RodElement>& elements = statics.chain().elements();
  if (target.position)
    nodes_.push_back({elements.size() - 1, elements.back().grid().t.size() - 1, *target.position});
  for (const RodTarget::Place& place : target.places) {
    const RodNode at = node_of(statics.chain(), place.place).value();
    nodes_.push_back({at.element, at.node, place.position});
  }
  if (target.rotation) angles_ = 3;
  if (target.direction) angles_ = 2;
  rows_ = 3 * static_cast<Eigen::Index>(nodes_.size()) + angles_;
  input_.tensions.resize(most_.size());
}

void RodTargetProblem::begin(const Equilibrium& near) {
  near_ = near;
  near_square_ = std::numeric_limits<double>::infinity();
}

void RodTargetProblem::linearise(const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd& J) {
  Equilibrium found = at(x, near_, r, J);
  const double square = r.squaredNorm();
  if (!found.converged() || (square >= near_square_ && !is_met(r))) return;
  near_ = std::move(found);
  near_square_ = square;
}

Equilibrium RodTargetProblem::at(const Eigen::VectorXd& x, const Equilibrium& near, Eigen::VectorXd& r,
                                 Eigen::MatrixXd& J) {
  ++evaluations;
  for (std::size_t i = 0; i < most_.size(); ++i)
    input_.tensions[i] = std::clamp(unit * x[static_cast<Eigen::Index>(i)], 0.0, most_[i]);
  Equilibrium found = statics_.solve(input_, loads_, near);
  r.setConstant(nowhere);
  J.setZero();
  if (!found.converged()) return found;
  try {
    slopes_ = statics_.slopes();
  } catch (const std::runtime_error&) {
    return found;  // At the limit of existence of an equilibrium.
  }
  const RodChain& chain = statics_.chain();
  Eigen::Index row = 0;
  for (const Node& node : nodes_) {
    const Eigen::Vector3d p = chain.elements()[node.element].poses()[node.node].position;
    chain.columns_at(node.element, node.node, columns_);
    twist_.noalias() = columns_ * slopes_.q_by_input;
    r.segment<3>(row) = (p - node.position) / length_;
    for (Eigen::Index c = 0; c < J.cols(); ++c) {
      const Eigen::Vector3d turn = twist_.col(c).tail<3>();
      J.block<3, 1>(row, c) = (unit / length_) * (twist_.col(c).head<3>() + turn.cross(p));
    }
    row += 3;
  }
  if (angles_ > 0) turn_rows(r, J);
  for (std::size_t i = 0; i < most_.size(); ++i)
    if (most_[i] == 0) J.col(static_cast<Eigen::Index>(i)).setZero();
  return found;
}

void RodTargetProblem::turn_rows(Eigen::VectorXd& r, Eigen::MatrixXd& J) const {
  const double weight = target_.angle_weight / length_;
  const Eigen::Matrix3d& R = statics_.chain().tip().rotation;
  const Eigen::Matrix3Xd turn = slopes_.tip_by_input.bottomRows<3>();
  if (target_.rotation) {
    const Eigen::Vector3d error = so3_log(R * target_.rotation->transpose());
    r.tail<3>() = weight * error;
    J.bottomRows<3>() = weight * unit * pseudo_inverse(so3_left_jacobian(error)) * turn;
    return;
  }
  // Components in two axes perpendicular to the direction; their length is the angle.
  const Eigen::Matrix3d axes = rotation_from_z(*target_.direction);
  const Eigen::Vector3d z = R.col(2), in_axes = axes.transpose() * z;
  const double angle = std::atan2(in_axes.head<2>().norm(), in_axes.z());
  const TurnFactor factor = turn_factor(angle);
  r.tail<2>() = weight * factor.value * in_axes.head<2>();
  for (Eigen::Index c = 0; c < J.cols(); ++c) {
    const Eigen::Vector3d moved = axes.transpose() * Eigen::Vector3d(turn.col(c)).cross(z);
    J.col(c).tail<2>() =
        weight * unit * (factor.value * moved.head<2>() + factor.by_cosine * moved.z() * in_axes.head<2>());
  }
}

double RodTargetProblem::position_error(const Eigen::VectorXd& r) const {
  double most = 0;
  for (Eigen::Index row = 0; row + 3 <= rows_ - angles_; row += 3)
    most = std::max(most, length_ * r.segment<3>(row).norm());
  return most;
}

double RodTargetProblem::angle_error(const Eigen::VectorXd& r) const {
  return angles_ > 0 ? length_ / target_.angle_weight * r.tail(angles_).norm() : 0;
}

bool RodTargetProblem::is_met(const Eigen::VectorXd& r) const {
  for (Eigen::Index row = 0; row + 3 <= rows_ - angles_; row += 3)
    if (!(r.segment<3>(row).norm() <= tolerance_)) return false;
  return angles_ == 0 || r.tail(angles_).norm() <= tolerance_;
}

}  // namespace flexura
