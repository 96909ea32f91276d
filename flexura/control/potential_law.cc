#include "flexura/control/potential_law.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include "flexura/math/dense.h"

namespace flexura {
namespace {

// Returns true if elasticity has its least energy there, up to rounding.
bool is_unstrained(const DistributedArm& arm) {
  constexpr double rounding = 1e-9;  // In rad; share of a length.
  const DistributedArmModel& model = arm.model();
  const double turn = (arm.direction().colwise() - arm.direction().col(0).eval()).cwiseAbs().maxCoeff();
  const double strain = (arm.stretch().array() - 1).abs().maxCoeff();
  return (model.bending_stiffness == 0 || turn <= rounding) &&
         (model.axial_stiffness == 0 || strain <= rounding);
}

}  // namespace

PotentialLaw::PotentialLaw(const DistributedArm& arm, Eigen::VectorXd target, const PotentialGains& gains)
    : gains_(gains), target_(std::move(target)) {
  if (target_.size() != arm.size() || !target_.allFinite())
    throw std::invalid_argument("a potential's target must be finite coordinates of its arm");
  if (!gains.stiffness.allFinite() || !gains.damping.allFinite() || !std::isfinite(gains.length_stiffness) ||
      !std::isfinite(gains.length_damping) || !std::isfinite(gains.gravity_share) ||
      !std::isfinite(gains.sign))
    throw std::invalid_argument("a potential law's numbers must be finite");
  const AngleShapes& shapes = arm.shapes();
  const Eigen::Index n = arm.nodes(), lengths = arm.size() - 2 * n;
  // Integrals of products of two shape functions.
  const Eigen::MatrixXd products = shapes.values.transpose() * shapes.weights.asDiagonal() * shapes.values;
  stiffness_ = damping_ = Eigen::MatrixXd::Zero(arm.size(), arm.size());
  for (Eigen::Index i = 0; i < 2; ++i) {
    stiffness_.block(i * n, i * n, n, n) = gains.stiffness[i] * products;
    for (Eigen::Index k = 0; k < 2; ++k) damping_.block(i * n, k * n, n, n) = gains.damping(i, k) * products;
  }
  has_lengths_ = lengths > 0;
  stiffness_.diagonal().tail(lengths).setConstant(gains.length_stiffness);
  damping_.diagonal().tail(lengths).setConstant(gains.length_damping);
  DistributedArm there = arm;
  there.set(target_, Eigen::VectorXd::Zero(arm.size()));
  // Nothing has to be added: V_e itself has its minimum where Pi has its own.
  if (gains_.elasticity == ElasticityRule::ignored && is_unstrained(there))
    gains_.elasticity = ElasticityRule::shaped;
  elastic_at_target_ = there.elastic_gradient();
  elastic_energy_at_target_ = there.elastic_energy();
  stiffness_at_target_ = there.stiffness();
  DistributedArmModel weight = arm.model();
  weight.bending_stiffness = weight.axial_stiffness = 0;
  DistributedArm limp(weight);
  limp.set(target_, Eigen::VectorXd::Zero(arm.size()));
  gravity_stiffness_ = limp.stiffness();
}

std::vector<std::string> PotentialLaw::violations() const {
  std::vector<std::string> found;
  if (gains_.sign != 1)
    found.push_back(fmt::format(
        "the potential's force has the sign {:+g}, not +1: the force drives the arm away from the target",
        gains_.sign));
  if (gains_.stiffness.minCoeff() <= 0 || (has_lengths_ && gains_.length_stiffness <= 0))
    found.emplace_back("the potential has no minimum at the target: a stiffness k is not above 0");
  const Eigen::Matrix2d K = 0.5 * (gains_.damping + gains_.damping.transpose());
  if (least_eigenvalue(K) <= 0)
    found.push_back(fmt::format("the damping K is not positive definite: its least eigenvalue is {:.3g}",
                                least_eigenvalue(K)));
  if (has_lengths_ && gains_.length_damping <= 0)
    found.push_back(
        fmt::format("the damping of section lengths is not positive: it is {:.3g}", gains_.length_damping));
  if (gains_.gravity_share != 1)
    found.push_back(fmt::format("{:.3g} % of gravity is compensated, not 100 %", 100 * gains_.gravity_share));
  if (gains_.elasticity == ElasticityRule::ignored)
    found.emplace_back(
        "the arm's elasticity is neither cancelled nor part of the potential, and pulls the arm away from "
        "the target");
  if (gains_.elasticity == ElasticityRule::shaped &&
      least_eigenvalue(stiffness_ + stiffness_at_target_ - gravity_stiffness_) <= 0)
    found.emplace_back("potential and elasticity together have no minimum at the target");
  return found;
}

void PotentialLaw::compensate(const DistributedArm& arm, const Eigen::VectorXd& v, Eigen::VectorXd& Q) const {
  Q += gains_.gravity_share * arm.gravity_gradient();
  if (gains_.elasticity == ElasticityRule::cancelled) Q += arm.elastic_gradient();
  if (gains_.elasticity == ElasticityRule::shaped) Q += elastic_at_target_;
  Q.noalias() -= damping_ * v;
}

void PotentialLaw::force(const DistributedArm& arm, const Eigen::VectorXd& x, const Eigen::VectorXd& v,
                         Eigen::VectorXd& Q) const {
  Q.resize(arm.size());
  Q.noalias() = stiffness_ * target_;
  Q.noalias() -= stiffness_ * x;
  Q *= gains_.sign;
  compensate(arm, v, Q);
}

void PotentialLaw::force_of_errors(const DistributedArm& arm, const Eigen::VectorXd& e_theta,
                                   const Eigen::VectorXd& e_q, const Eigen::VectorXd& x,
                                   const Eigen::VectorXd& v, Eigen::VectorXd& Q) const {
  const AngleShapes& shapes = arm.shapes();
  const Eigen::Index n = arm.nodes(), lengths = arm.size() - 2 * n;
  if (e_theta.size() != shapes.s.size() || e_q.size() != shapes.s.size())
    throw std::invalid_argument("a potential law needs one error for each point of its arm");
  Q.resize(arm.size());
  for (Eigen::Index a = 0; a < n; ++a) {
    double by_theta = 0, by_q = 0;
    for (Eigen::Index j = 0; j < shapes.s.size(); ++j) {
      const double share = shapes.weights[j] * shapes.values(j, a);
      by_theta += share * e_theta[j], by_q += share * e_q[j];
    }
    Q[a] = -gains_.sign * gains_.stiffness[0] * by_theta;
    Q[n + a] = -gains_.sign * gains_.stiffness[1] * by_q;
  }
  Q.tail(lengths) = -gains_.sign * gains_.length_stiffness * (x - target_).tail(lengths);
  compensate(arm, v, Q);
}

double PotentialLaw::potential(const DistributedArm& arm, const Eigen::VectorXd& x) const {
  double quadratic = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i)
    for (Eigen::Index k = 0; k < x.size(); ++k)
      quadratic += 0.5 * (x[i] - target_[i]) * stiffness_(i, k) * (x[k] - target_[k]);
  if (gains_.elasticity != ElasticityRule::shaped) return quadratic;
  return quadratic + arm.elastic_energy() - elastic_energy_at_target_ - elastic_at_target_.dot(x - target_);
}

}  // namespace flexura
