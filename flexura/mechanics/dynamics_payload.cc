#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "flexura/mechanics/dynamics_work.h"

namespace flexura {
namespace {

Eigen::Vector3d vector(const Triple<double>& a) { return {a.x, a.y, a.z}; }
Triple<double> as_triple(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Vector6d vector(const Screw<double>& a) {
  return (Vector6d() << vector(a.linear), vector(a.angular)).finished();
}

// Combines a body and a point mass.
RodLayout::Body with_point(const RodLayout::Body& body, double mass, const Eigen::Vector3d& at) {
  const double all = body.mass + mass;
  if (!(all > 0)) return body;
  const Eigen::Vector3d centre = vector(body.centre), apart = at - centre, both = centre + mass / all * apart;
  // The reduced mass.
  const Eigen::Matrix3d more =
      body.mass / all * mass *
      (apart.squaredNorm() * Eigen::Matrix3d::Identity() - apart * apart.transpose());
  RodLayout::Body result{.mass = all, .centre = as_triple(both), .inertia = body.inertia};
  for (std::size_t row = 0; row < 3; ++row)
    result.inertia[row] += as_triple(more.row(static_cast<Eigen::Index>(row)));
  return result;
}

}  // namespace

RodState RodDynamics::pick_up(const RodState& state, const RodPayload& payload, const TendonInput& tendons,
                              const RodLoads& loads) {
  constexpr double most = 1e100;  // Inertia and energy of larger numbers are not finite.
  if (!(payload.mass >= 0) || !(payload.mass < most) || !(payload.offset.norm() < most) ||
      !(payload.velocity.norm() < most))
    throw std::invalid_argument("the numbers of a payload must be finite, and its mass must be at least 0");
  Work& work = *work_;
  if (state.q.size() != work.chain.size() || !state.q.allFinite() || !state.momentum.allFinite())
    throw std::invalid_argument("the state belongs to another rod, or is not finite");
  const std::size_t node = work.layout.node_of(payload.place);
  // Momentum of the payload: J^T m u.
  work.velocity.setZero();
  work.motion.place(state.q.data(), work.velocity.data());
  const Placement<double>& X = work.motion.nodes()[node];
  const Triple<double> push = as_triple(payload.mass * payload.velocity);
  std::vector<Screw<double>> wrenches(work.layout.nodes);
  wrenches[node] = {push, cross(X.position + X.turn(as_triple(payload.offset)), push)};
  Eigen::VectorXd brought = Eigen::VectorXd::Zero(work.chain.size());
  work.motion.collect(wrenches, brought.data());

  RodLayout::Body& body = work.layout.bodies[node];
  const RodLayout::Body before = body;
  if (std::ranges::none_of(work.bare, [&](const auto& each) { return each.first == node; }))
    work.bare.emplace_back(node, before);
  body = with_point(before, payload.mass, payload.offset);
  RodState both = state;
  both.momentum += brought;
  const Eigen::VectorXd v = velocity(both);
  RodState after = start(state.q, v, tendons, loads);
  if (work.rubs()) {
    // Friction of the tendons persists.
    work.hold(state.friction.data(), 0);
    work.set_forces(after, v, tendons, loads);
  }
  after.time = state.time;
  return after;
}

RodState RodDynamics::drop(const RodState& state, const RodPlace& place, const TendonInput& tendons,
                           const RodLoads& loads) {
  Work& work = *work_;
  const std::size_t node = work.layout.node_of(place);
  const Eigen::VectorXd v = velocity(state);
  const auto found = std::ranges::find_if(work.bare, [&](const auto& each) { return each.first == node; });
  if (found != work.bare.end()) {
    work.layout.bodies[node] = found->second;
    work.bare.erase(found);
  }
  RodState after = start(state.q, v, tendons, loads);
  if (work.rubs()) {
    // Friction of the tendons persists.
    work.hold(state.friction.data(), 0);
    work.set_forces(after, v, tendons, loads);
  }
  after.time = state.time;
  return after;
}

std::vector<NodeMotion> RodDynamics::motions(const RodState& state) {
  const Eigen::VectorXd v = velocity(state);
  work_->motion.place(state.q.data(), v.data());
  std::vector<NodeMotion> result(work_->layout.nodes);
  for (std::size_t k = 0; k < result.size(); ++k) {
    const Placement<double>& X = work_->motion.nodes()[k];
    result[k].pose.rotation << vector(X.x).transpose(), vector(X.y).transpose(), vector(X.z).transpose();
    result[k].pose.position = vector(X.position);
    result[k].twist = vector(work_->motion.velocities()[k]);
  }
  return result;
}

std::span<const double> RodDynamics::node_runs() const { return work_->layout.run; }

}  // namespace flexura
