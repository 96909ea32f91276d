#include "flexura/mechanics/rod_drag.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "flexura/math/so3.h"

namespace flexura {

RodDrag::RodDrag(const RodChain& chain, const RodDragConfig& config) : config_(config) {
  for (const double value : {config.density, config.across_coefficient, config.along_coefficient,
                             config.linear_across, config.linear_along})
    if (!(value >= 0) || !std::isfinite(value))
      throw std::invalid_argument("drag: density and coefficients must be at least 0 and finite");
  if (!config.flow.allFinite()) throw std::invalid_argument("drag: the flow must be finite");
  const std::vector<RodSection>& sections = chain.rod().sections;
  if (!config.radii.empty() && config.radii.size() != sections.size())
    throw std::invalid_argument(fmt::format("drag: {} pairs of radii for {} sections: expected one each",
                                            config.radii.size(), sections.size()));
  for (std::size_t i = 0; i < sections.size(); ++i) {
    const std::array<double, 2> radius = config.radii.empty() ? sections[i].radius : config.radii[i];
    for (const double each : radius)
      if (!(each > 0) || !std::isfinite(each))
        throw std::invalid_argument(
            fmt::format("drag, section {}: a radius must be above 0 and finite", i + 1));
  }
  for (const RodElement& element : chain.elements()) {
    const std::size_t i = element.part().section;
    const std::array<double, 2> radius = config.radii.empty() ? sections[i].radius : config.radii[i];
    for (const double at : element.grid().t) {
      const double t = element.part().of_section(at);
      const double head = config.density * (radius[0] + t * (radius[1] - radius[0]));
      nodes_.push_back({.across = head * config.across_coefficient,
                        .along = std::numbers::pi * head * config.along_coefficient});
    }
  }
}

RodDrag::Force RodDrag::force_at(const Node& node, const Eigen::Vector3d& velocity,
                                 const Eigen::Vector3d& tangent) const {
  const Eigen::Matrix3d lengthwise = tangent * tangent.transpose(),
                        crosswise = Eigen::Matrix3d::Identity() - lengthwise;
  const double along = tangent.dot(velocity);
  const Eigen::Vector3d across = velocity - along * tangent;
  const double speed = across.norm();
  const double on_across = node.across * speed + config_.linear_across,
               on_along = node.along * std::abs(along) + config_.linear_along;
  Force result;
  result.force = -on_across * across - on_along * along * tangent;
  Eigen::Matrix3d by_across = -on_across * Eigen::Matrix3d::Identity();
  if (speed > 0) by_across -= node.across / speed * across * across.transpose();
  const double by_along = -(2 * node.along * std::abs(along) + config_.linear_along);
  result.by_velocity = by_across * crosswise + by_along * lengthwise;
  // d across = -tangent (velocity . d tangent) - along d tangent.
  const Eigen::Matrix3d across_by_tangent =
      -tangent * velocity.transpose() - along * Eigen::Matrix3d::Identity();
  result.by_tangent = by_across * across_by_tangent + by_along * tangent * velocity.transpose() -
                      on_along * along * Eigen::Matrix3d::Identity();
  return result;
}

void RodDrag::pull(std::span<const NodeMotion> nodes, std::span<const double> run,
                   std::span<NodePull> pulls) const {
  if (nodes.size() != nodes_.size() || pulls.size() != nodes_.size())
    throw std::invalid_argument("drag: expected a rod with the same nodes");
  using Rows = Eigen::Matrix<double, 3, 6>;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    NodePull& pull = pulls[k];
    if (run[k] == 0) {
      pull.clear();
      continue;
    }
    const Eigen::Vector3d p = nodes[k].pose.position, t = nodes[k].pose.rotation.col(2),
                          w = nodes[k].twist.tail<3>();
    const Eigen::Vector3d velocity = nodes[k].twist.head<3>() + w.cross(p) - config_.flow;
    const Force at = force_at(nodes_[k], velocity, t);
    const Eigen::Vector3d force = run[k] * at.force;
    Rows moved;
    moved << Eigen::Matrix3d::Identity(), -skew(p);
    const Rows by_twist = run[k] * at.by_velocity * moved;
    Rows by_pose = run[k] * at.by_velocity * skew(w) * moved;
    by_pose.rightCols<3>() -= run[k] * at.by_tangent * skew(t);
    pull.wrench << force, p.cross(force);
    pull.by_twist << by_twist, skew(p) * by_twist;
    pull.by_pose << by_pose, skew(p) * by_pose - skew(force) * moved;
    pull.is_idle = false;
    // by_velocity of the force is negative semidefinite.
    pull.is_held = true;
    pull.stiffness.setZero();
    pull.damping = -moved.transpose() * by_twist;
  }
}

double RodDrag::power(std::span<const NodeMotion> nodes, std::span<const double> run) const {
  if (nodes.size() != nodes_.size() || run.size() != nodes_.size())
    throw std::invalid_argument("drag: expected a rod with the same nodes");
  double power = 0;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Eigen::Vector3d velocity =
        nodes[k].twist.head<3>() + nodes[k].twist.tail<3>().cross(nodes[k].pose.position);
    const Force at = force_at(nodes_[k], velocity - config_.flow, nodes[k].pose.rotation.col(2));
    power += run[k] * at.force.dot(velocity);
  }
  return power;
}

}  // namespace flexura
