#include "flexura/sim/rod_plant.h"

#include <algorithm>

#include "flexura/mechanics/rod_spring.h"

namespace flexura {
namespace {

// Returns the point of the backbone with this arc length at rest.
Eigen::Vector3d point_at_rest(const Backbone& backbone, double s_rest) {
  const auto after = std::ranges::upper_bound(backbone.arcs(), s_rest, {}, &Arc::s_rest);
  const Arc& arc = after == backbone.arcs().begin() ? *after : *(after - 1);
  const double part = std::clamp((s_rest - arc.s_rest) / arc.rest_length, 0.0, 1.0);
  return arc.pose(part * arc.length).position;
}

}  // namespace

void RodPlant::command(double time, const Eigen::VectorXd& u, double duration) {
  inputs_.command(time, u, duration);
  forget();
}

void RodPlant::halt(double time) {
  inputs_.halt(time);
  forget();
}

std::optional<ArmState> RodPlant::pull(double time, const std::vector<double>& displacements,
                                       double duration) {
  std::optional<ArmState> nearest = inputs_.pull(time, displacements, duration);
  forget();
  return nearest;
}

bool RodPlant::weigh(double time, bool on) {
  const bool has_weight = inputs_.weigh(time, on);
  forget();
  return has_weight;
}

bool RodPlant::push(double time, const std::optional<PlantPush>& push) {
  inputs_.push(time, push);
  forget();
  return true;
}

std::optional<PlantPushForce> RodPlant::push_force(double time) const {
  const std::optional<PlantPush> push = inputs_.pushed(time);
  const std::optional<PointSpring> spring = inputs_.spring(time);
  if (!push || !spring) return std::nullopt;
  const Eigen::Vector3d point = point_at_rest(backbone(time), push->s_rest);
  return PlantPushForce{push->s_rest, point, X_WB_.rotation * spring_force(*spring, X_WB_.inverse() * point)};
}

}  // namespace flexura
