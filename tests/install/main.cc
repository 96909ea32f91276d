// A project of its own that uses an installed Flexura: where does the paper's arm end?
#include <cstdio>
#include <numbers>
#include <vector>

#include "flexura/kinematics/planar.h"
#include "flexura/model/backbone.h"

int main() {
  const std::vector<double> lengths = {2, 3, 1, 2, 4, 2, 1, 1};
  std::vector<double> cord_angles = {0.55, 0.65, 0.8, 1, 1.15, 0.9, 0.8, 0.65};
  for (double& angle : cord_angles) angle *= std::numbers::pi;

  flexura::Arm arm;
  for (const double length : lengths) arm.sections.push_back({.length = length});
  const auto base_tangent = flexura::base_tangent_angle(arm.X_WB);
  const auto bends =
      flexura::bends_from_archings(flexura::archings_from_cord_angles(base_tangent, cord_angles));
  const flexura::Backbone backbone(arm, {.bends = bends, .stretches = std::vector<double>(lengths.size(), 1)});

  const auto& tip = backbone.tip().position;
  std::printf("E = (%.3f, %.3f)\n", tip.x(), tip.y());
}
