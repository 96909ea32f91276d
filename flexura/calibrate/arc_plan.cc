#include "flexura/calibrate/arc_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "flexura/base/degree.h"
#include "flexura/calibrate/rig_aim.h"
#include "flexura/math/arrays.h"
#include "flexura/model/backbone.h"

namespace flexura {
namespace {

// The plane of camera i's arc.
const char* name_of_plane(std::size_t i) { return i == 0 ? "XOY" : "ZOY"; }

}  // namespace

std::optional<ArmState> arc_state(const Arm& arm, double bend, const Eigen::Vector3d& towards) {
  const Eigen::Vector3d local = arm.X_WB.rotation.transpose() * towards;
  constexpr double slanted = 1e-6;
  if (std::abs(local.z()) > slanted) return std::nullopt;
  if (arm.kind == ArmKind::planar && std::abs(local.y()) > slanted) return std::nullopt;
  ArmState state = ArmState::straight(arm.sections.size());
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const Section& section = arm.sections[i];
    const double share = bend * section.length / arm.length();
    if (share > section.max_bend) return std::nullopt;
    state.bends[i] = share * local.head<2>().normalized();
    const auto& [least, longest] = section.stretch_limits;
    state.stretches[i] = std::clamp(1.0, least, longest);
  }
  return state;
}

std::optional<std::string> plan_arcs(LookLoop& loop, bool aims_at_centers, ArcPlan& plan) {
  const Arm& arm = loop.nominal().arm;
  const double bend = loop.config().arc;
  plan.radius = arm.length() / bend;
  plan.normals = {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX()};
  // Points each normal towards the modelled position of its camera; the arcs bend away from the other camera.
  for (std::size_t i = 0; i < 2; ++i)
    if (vector(loop.model(i).mount.position).dot(plan.normals[i]) < arm.X_WB.position.dot(plan.normals[i]))
      plan.normals[i] = -plan.normals[i];
  const std::array<Eigen::Vector3d, 2> towards = {-plan.normals[1], -plan.normals[0]};
  std::array<Eigen::Vector3d, 2> middles;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto state = arc_state(arm, bend, towards[i]);
    if (!state)
      return fmt::format("the arm cannot be bent into an arc of {:.0f} deg in {}", bend / degree,
                         name_of_plane(i));
    plan.arcs[i] = loop.nominal().arm_model().actuation().command(*state);
    const Backbone backbone(arm, *state);
    plan.centers[i] = backbone.pose(0).position + plan.radius * towards[i];
    middles[i] = aims_at_centers ? plan.centers[i] : backbone.pose(0.5 * arm.length()).position;
  }
  plan.target = {middles[0].x(), 0.5 * (middles[0].y() + middles[1].y()), middles[1].z()};
  // The smallest magnification that both cameras reach, with a margin for making it smaller still.
  double magnification = 0;
  std::array<double, 2> distances{}, depths{};
  for (std::size_t i = 0; i < 2; ++i) {
    distances[i] = (vector(loop.model(i).mount.position) - plan.centers[i]).dot(plan.normals[i]);
    if (distances[i] < 2 * plan.radius)
      return fmt::format(
          "camera {} is nominally {:.3g} m from the plane {}: expected at least twice the arc's radius"
          "least",
          loop.name(i), distances[i], name_of_plane(i));
    depths[i] = distances[i] - (plan.target - plan.centers[i]).dot(plan.normals[i]);
    constexpr double spare = 1.15;
    const Camera& camera = loop.camera(i);
    magnification = std::max(magnification, spare * (camera.lens().at(zoom_ends(camera)[0]).fx / depths[i]));
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const Camera& camera = loop.camera(i);
    const double least = zoom_ends(camera)[0];
    plan.zoom[i] = zoom_by(camera, least, magnification * depths[i] / camera.lens().at(least).fx);
    const Eigen::Vector3d& along = plan.normals[i];
    View& view = plan.ideal[i];
    view.lens = Lens(camera.lens().at(plan.zoom[i]));
    view.X_WC.rotation = upright(-along).value_or(Eigen::Matrix3d::Identity());
    view.X_WC.position =
        plan.target - along.dot(plan.target - plan.centers[i]) * along + distances[i] * along;
    view.width = static_cast<int>(camera.config().sensor.width);
    view.height = static_cast<int>(camera.config().sensor.height);
    plan.pictures[i] = loop.config().draw(view, plan.arcs[i]);
    loop.plan(i, name_of_plane(i), plan.arcs[i], view, plan.pictures[i]);
  }
  return std::nullopt;
}

}  // namespace flexura
