#include "flexura/mechanics/rod_spring.h"

#include <cmath>
#include <stdexcept>

#include "flexura/math/so3.h"

namespace flexura {

std::string spring_problem(const PointSpring& spring) {
  if (!spring.to.allFinite() || !spring.force.allFinite()) return "a spring's place or force is not finite";
  const bool is_inside = spring.at >= 0 && spring.at <= 1;
  if (!is_inside) return "a spring's place is outside its section";
  if (!(spring.stiffness >= 0) || !std::isfinite(spring.stiffness))
    return "a spring's stiffness must be at least 0 and finite";
  if (!(spring.most > 0) || !std::isfinite(spring.most))
    return "a spring's largest force must be above 0 and finite";
  return "";
}

Eigen::Vector3d spring_force(const PointSpring& spring, const Eigen::Vector3d& point) {
  const Eigen::Vector3d drawn = spring.stiffness * (spring.to - point);
  return drawn / std::hypot(1.0, drawn.norm() / spring.most) + spring.force;
}

SpringPull spring_pull(const PointSpring& spring, const Eigen::Vector3d& point) {
  using Rows = Eigen::Matrix<double, 3, 6>;
  const Eigen::Vector3d share = spring.stiffness * (spring.to - point) / spring.most;
  const double soft = std::hypot(1.0, share.norm());
  // Derivative of the force by the point, negated.
  const Eigen::Matrix3d k =
      spring.stiffness / soft * (Eigen::Matrix3d::Identity() - share * share.transpose() / (soft * soft));
  const Eigen::Vector3d force = spring_force(spring, point);
  Rows moved;
  moved << Eigen::Matrix3d::Identity(), -skew(point);
  const Rows by_pose = -k * moved;
  SpringPull pull;
  pull.wrench << force, point.cross(force);
  pull.by_pose << by_pose, skew(point) * by_pose - skew(force) * moved;
  pull.stiffness = moved.transpose() * k * moved;
  return pull;
}

RodSpring::RodSpring(const RodChain& chain, const RodPlace& place) {
  const RodNode at = chain.node_of(place);
  for (std::size_t i = 0; i < at.element; ++i) node_ += chain.elements()[i].grid().t.size();
  node_ += at.node;
}

void RodSpring::set(const std::optional<PointSpring>& spring) {
  if (spring)
    if (const std::string problem = spring_problem(*spring); !problem.empty())
      throw std::invalid_argument(problem);
  spring_ = spring;
}

void RodSpring::pull(std::span<const NodeMotion> nodes, std::span<const double> /*run*/,
                     std::span<NodePull> pulls) const {
  if (node_ >= nodes.size() || pulls.size() != nodes.size())
    throw std::invalid_argument("spring: expected a rod with the same nodes");
  for (NodePull& pull : pulls) pull.clear();
  if (!spring_) return;
  const SpringPull at = spring_pull(*spring_, nodes[node_].pose.position);
  NodePull& pull = pulls[node_];
  pull.is_idle = false;
  pull.wrench = at.wrench;
  pull.by_pose = at.by_pose;
  // The rotation of the force's lever may have negative eigenvalues.
  pull.is_held = true;
  pull.stiffness = at.stiffness;
}

}  // namespace flexura
