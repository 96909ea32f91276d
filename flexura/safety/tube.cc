#include "flexura/safety/tube.h"

#include <numbers>

#include "flexura/math/series.h"
#include "flexura/model/backbone.h"

namespace flexura {

Eigen::Vector3d SectionTube::point(double u) const {
  const Eigen::Vector2d part = bend * u;
  const double t = part.norm();
  const Eigen::Vector2d across = cosc(t) * part;
  return X_WS.position + (length * u) * (X_WS.rotation * Eigen::Vector3d(across.x(), across.y(), sinc(t)));
}

std::vector<SectionTube> tube_arcs(const Arm& arm, const ArmState& state) {
  const Backbone backbone(arm, state);
  std::vector<SectionTube> tubes;
  tubes.reserve(arm.sections.size());
  constexpr double quarter = std::numbers::pi / 2;
  double turn = 0;
  double start = 0;
  for (const Arc& arc : backbone.arcs()) {
    const std::array<double, 2>& radius = arc.radius;
    tubes.push_back(
        {arc.X_WS, arc.bend, arc.length, radius, turn, start, {quarter * radius[0], quarter * radius[1]}});
    turn += arc.bend.norm();
    start += arc.length;
  }
  return tubes;
}

}  // namespace flexura
