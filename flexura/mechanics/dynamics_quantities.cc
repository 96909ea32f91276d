// Quantities of a rod in motion at a state: energies, momenta, poses and accelerations.
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "flexura/mechanics/dynamics_work.h"

namespace flexura {
namespace {

Eigen::Vector3d eigen_of(const Triple<double>& a) { return {a.x, a.y, a.z}; }
Vector6d eigen_of(const Screw<double>& a) {
  return (Vector6d() << eigen_of(a.linear), eigen_of(a.angular)).finished();
}
Pose pose_of(const Placement<double>& at) {
  Pose X;
  X.rotation << eigen_of(at.x).transpose(), eigen_of(at.y).transpose(), eigen_of(at.z).transpose();
  X.position = eigen_of(at.position);
  return X;
}

}  // namespace

double RodDynamics::step_error(const RodState& state) {
  if (state.middles < 3) return 0;
  work_->velocity.setZero();
  work_->motion.place(state.q.data(), work_->velocity.data());
  work_->matrix.find_columns(work_->motion);
  const Eigen::VectorXd error =
      work_->scheme.error * state.step * (state.middle[0] - 2 * state.middle[1] + state.middle[2]);
  const Vector6d twist = work_->matrix.tip_change(error.data());
  const Eigen::Vector3d tip = eigen_of(work_->motion.nodes().back().position);
  return (twist.head<3>() + twist.tail<3>().cross(tip)).norm();
}

Eigen::VectorXd RodDynamics::velocity(const RodState& state) {
  if (!work_->find_velocity(state))
    throw std::invalid_argument("the state has no positive definite mass matrix");
  return work_->velocity;
}

RodEnergy RodDynamics::energy(const RodState& state, const RodLoads& loads) {
  const Eigen::VectorXd v = velocity(state);
  RodEnergy energy{.kinetic = 0.5 * v.dot(state.momentum)};
  const RodLayout& layout = work_->layout;
  if (layout.is_driven) {
    work_->motion.place(state.q.data(), v.data());
    energy.kinetic = 0;
    for (std::size_t k = 0; k < layout.nodes; ++k) {
      const Screw<double>&P = work_->motion.momenta()[k], &V = work_->motion.velocities()[k];
      energy.kinetic += 0.5 * (dot(P.linear, V.linear) + dot(P.angular, V.angular));
    }
  }
  for (const RodLayout::Section& section : layout.sections) {
    const auto q = state.q.segment(static_cast<Eigen::Index>(section.first_mode),
                                   static_cast<Eigen::Index>(section.modes));
    energy.strain += 0.5 * q.dot(section.stiffness * q);
  }
  for (std::size_t k = 0; k < layout.nodes; ++k) {
    const Pose X = pose_of(work_->motion.nodes()[k]);
    energy.gravity -= layout.bodies[k].mass * loads.gravity.dot(X * eigen_of(layout.bodies[k].centre)) +
                      layout.run[k] * loads.per_length.dot(X.position);
  }
  return energy;
}

double RodDynamics::dissipation(const RodState& state) {
  const Eigen::VectorXd v = velocity(state);
  double power = 0;
  for (const RodLayout::Section& section : work_->layout.sections) {
    const auto part =
        v.segment(static_cast<Eigen::Index>(section.first_mode), static_cast<Eigen::Index>(section.modes));
    power += part.dot(section.damping * part);
  }
  return power;
}

Vector6d RodDynamics::momentum(const RodState& state) {
  const Eigen::VectorXd v = velocity(state);
  work_->motion.place(state.q.data(), v.data());
  Vector6d sum = Vector6d::Zero();
  for (const Screw<double>& part : work_->motion.momenta()) sum += eigen_of(part);
  return sum;
}

NodeMotion RodDynamics::motion(const RodState& state, const RodPlace& place) {
  const std::size_t node = work_->layout.node_of(place);
  const Eigen::VectorXd v = velocity(state);
  work_->motion.place(state.q.data(), v.data());
  return {.pose = pose_of(work_->motion.nodes()[node]), .twist = eigen_of(work_->motion.velocities()[node])};
}

std::vector<NodeMotion> RodDynamics::point_motions(const RodState& state) {
  const Eigen::VectorXd v = velocity(state);
  work_->motion.place(state.q.data(), v.data());
  return work_->motion.all_point_motions();
}

Pose RodDynamics::tip(const RodState& state) {
  work_->velocity.setZero();
  work_->motion.place(state.q.data(), work_->velocity.data());
  return pose_of(work_->motion.nodes().back());
}

std::vector<double> RodDynamics::tendon_lengths(const RodState& state) {
  work_->velocity.setZero();
  work_->motion.place(state.q.data(), work_->velocity.data());
  std::vector<double> lengths(work_->chain.tendons());
  work_->motion.find_lengths(lengths.data());
  return lengths;
}

Eigen::MatrixXd RodDynamics::mass_matrix(const Eigen::VectorXd& q) {
  if (q.size() != work_->chain.size()) throw std::invalid_argument("the modes belong to another rod");
  work_->velocity.setZero();
  work_->motion.place(q.data(), work_->velocity.data());
  work_->matrix.find_columns(work_->motion);
  return work_->matrix.dense_mass(work_->motion);
}

Eigen::VectorXd RodDynamics::acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                          const TendonInput& tendons, const RodLoads& loads) {
  const std::string problem = work_->input_problem(tendons, loads);
  if (!problem.empty()) throw std::invalid_argument(problem);
  if (q.size() != work_->chain.size() || v.size() != q.size())
    throw std::invalid_argument("the modes belong to another rod");
  Eigen::VectorXd force(q.size());
  work_->hold(nullptr, Work::has_slid);
  work_->motion.place(q.data(), v.data());
  work_->set_tensions(tendons);
  work_->motion.pull(loads, work_->tensions.data(), work_->surroundings);
  work_->motion.find_acceleration_forces(force.data());
  work_->matrix.find_columns(work_->motion);
  if (!work_->matrix.factor(work_->motion, {}, nullptr, false))
    throw std::invalid_argument("the shape has no positive definite mass matrix");
  work_->matrix.solve(force.data());
  return force;
}

}  // namespace flexura
