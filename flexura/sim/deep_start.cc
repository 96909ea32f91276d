#include "flexura/sim/deep_start.h"

#include <algorithm>
#include <limits>
#include <variant>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_contact.h"
#include "flexura/mechanics/statics.h"
#include "flexura/sim/arm_setup.h"
#include "flexura/sim/rod_inputs.h"
#include "flexura/sim/start_command.h"

namespace flexura {
namespace {

// Returns the radius of the largest ball within an obstacle, m.
double smallest_size(const ObstacleConfig& obstacle) {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  if (const auto* sphere = std::get_if<SphereConfig>(&obstacle)) return sphere->radius;
  if (const auto* capsule = std::get_if<CapsuleConfig>(&obstacle)) return capsule->radius;
  if (const auto* box = std::get_if<BoxConfig>(&obstacle)) return std::ranges::min(box->half_sizes);
  return unlimited;
}

}  // namespace

std::optional<DeepStart> deep_start(const RigConfig& model, const RigConfig& truth) {
  if (truth.arm.mechanics != ArmMechanics::dynamics || !truth.arm.contact || truth.obstacles.empty())
    return {};
  const ArmSetup arm(truth);
  const RodInputs inputs({arm, start_command(ArmSetup(model), arm), 0});
  RodStatics statics(inputs.rod());
  statics.stretch_rest(inputs.rest_stretches(0));
  const Equilibrium rest =
      statics.solve({.displacements = inputs.displacements(0, inputs.nothing_lost())}, inputs.loads(0));
  if (!rest.converged()) return {};
  // First at the arm's own contact points. Then at points so near to each other that the smallest obstacle
  // does not fit between them.
  const RodContactConfig& own = arm.rod.value().contact.value();
  RodContactConfig dense = own;
  double size = inputs.rod().length() / 20;
  for (const ObstacleConfig& obstacle : truth.obstacles) size = std::min(size, smallest_size(obstacle));
  dense.places = contact_places(inputs.rod(), std::max(0.5 * size, inputs.rod().length() / 2000));
  dense.itself = false;
  std::optional<DeepStart> deepest;
  for (const RodContactConfig* config : {&own, static_cast<const RodContactConfig*>(&dense)}) {
    if (deepest) break;
    RodDynamics dynamics(inputs.rod());
    const RodContact contact(dynamics.chain(), *config);
    dynamics.set_surroundings(&contact);
    if (inputs.can_stretch()) {
      const std::vector<double> factors = inputs.rest_stretches(0);
      dynamics.stretch_rest(factors, std::vector<double>(factors.size(), 0.0));
    }
    for (const ContactForce& each : contact.find(dynamics.point_motions(dynamics.rest(rest)))) {
      if (!each.is_deep || !each.obstacle || (deepest && deepest->depth >= each.depth)) continue;
      double s = 0;
      for (std::size_t i = 0; i < each.place.section; ++i) s += inputs.rod().sections[i].length;
      deepest = {.obstacle = *each.obstacle,
                 .s_rest = s + each.place.at * inputs.rod().sections[each.place.section].length,
                 .depth = each.depth};
    }
  }
  return deepest;
}

}  // namespace flexura
