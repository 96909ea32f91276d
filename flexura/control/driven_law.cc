#include "flexura/control/driven_law.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

// G of drives of which each has one column of numbers for an angle's nodes.
Eigen::MatrixXd drive_map(const DistributedArm& arm, const Eigen::MatrixXd& of_an_angle) {
  const Eigen::Index n = arm.nodes(), sections = of_an_angle.cols(), lengths = arm.size() - 2 * n;
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(arm.size(), 2 * sections + lengths);
  for (Eigen::Index k = 0; k < sections; ++k) {
    G.col(2 * k).head(n) = of_an_angle.col(k);
    G.col(2 * k + 1).segment(n, n) = of_an_angle.col(k);
  }
  G.bottomRightCorner(lengths, lengths).setIdentity();
  return G;
}

}  // namespace

Eigen::MatrixXd section_torques(const DistributedArm& arm) {
  const AngleShapes& shapes = arm.shapes();
  Eigen::MatrixXd numbers =
      Eigen::MatrixXd::Zero(arm.nodes(), static_cast<Eigen::Index>(shapes.lengths.size()));
  for (Eigen::Index j = 0; j < shapes.s.size(); ++j)
    numbers.col(static_cast<Eigen::Index>(shapes.section[static_cast<std::size_t>(j)])) +=
        shapes.weights[j] * shapes.values.row(j).transpose();
  return drive_map(arm, numbers);
}

Eigen::MatrixXd section_moments(const DistributedArm& arm) {
  const AngleShapes& shapes = arm.shapes();
  const Eigen::Index n = arm.nodes();
  Eigen::MatrixXd numbers(n, static_cast<Eigen::Index>(shapes.lengths.size()));
  double start = 0;
  for (std::size_t k = 0; k < shapes.lengths.size(); ++k) {
    const double end = start + shapes.lengths[k];
    // The last end where rounding keeps it: the nodes' own.
    numbers.col(static_cast<Eigen::Index>(k)) =
        (shapes.at(end).head(n) - shapes.at(start).head(n)).transpose();
    start = end;
  }
  return drive_map(arm, numbers);
}

Eigen::MatrixXd drives_of(const DistributedArm& arm, DriveKind kind) {
  if (kind == DriveKind::torques) return section_torques(arm);
  if (kind == DriveKind::moments) return section_moments(arm);
  return {};
}

ProjectedForce project_on_drives(const Eigen::MatrixXd& G, const Eigen::VectorXd& Q) {
  if (G.rows() != Q.size()) throw std::invalid_argument("drives and forces of different arms");
  ProjectedForce projected;
  projected.drives = least_norm_solution(G, Q);
  projected.force = G * projected.drives;
  const double size = Q.norm();
  projected.left_over = size > 0 ? (Q - projected.force).norm() / size : 0;
  return projected;
}

DrivenLaw::DrivenLaw(const DistributedArm& arm, Eigen::MatrixXd G, Eigen::VectorXd target, double stiffness,
                     double damping)
    : G_(std::move(G)), target_(std::move(target)), stiffness_(stiffness), damping_(damping) {
  if (G_.rows() != arm.size() || target_.size() != arm.size())
    throw std::invalid_argument("a driven law's drives and target must fit its arm");
  if (!G_.allFinite() || !target_.allFinite() || !std::isfinite(stiffness) || !std::isfinite(damping))
    throw std::invalid_argument("a driven law's numbers must be finite");
  DistributedArm there = arm;
  there.set(target_, Eigen::VectorXd::Zero(arm.size()));
  energy_at_target_ = there.gravity_energy() + there.elastic_energy();
  const ProjectedForce held = project_on_drives(G_, there.gravity_gradient() + there.elastic_gradient());
  holding_ = held.drives, not_held_ = held.left_over;
  const Eigen::MatrixXd curvature = there.stiffness() + stiffness * G_ * G_.transpose();
  least_curvature_ = least_eigenvalue(curvature);
}

std::vector<std::string> DrivenLaw::violations() const {
  std::vector<std::string> found;
  if (not_held_ > 1e-6)
    found.push_back(fmt::format(
        "the drives cannot hold the arm at the target: {:.3g} % of the force is left over", 100 * not_held_));
  if (least_curvature_ <= 0)
    found.emplace_back(
        "the energy has no minimum at the target: stiffen the law, or the arm falls from there");
  if (damping_ <= 0) found.push_back(fmt::format("the damping K is not positive: {:.3g}", damping_));
  return found;
}

void DrivenLaw::force(const Eigen::VectorXd& x, const Eigen::VectorXd& v, Eigen::VectorXd& Q) const {
  Q = G_ * (holding_ - stiffness_ * (G_.transpose() * (x - target_)) - damping_ * (G_.transpose() * v));
}

double DrivenLaw::potential(const DistributedArm& arm, const Eigen::VectorXd& x) const {
  const Eigen::VectorXd y = G_.transpose() * (x - target_);
  return arm.gravity_energy() + arm.elastic_energy() - energy_at_target_ - holding_.dot(y) +
         0.5 * stiffness_ * y.squaredNorm();
}

double DrivenLaw::dissipation(const Eigen::VectorXd& v) const {
  return damping_ * (G_.transpose() * v).squaredNorm();
}

}  // namespace flexura
