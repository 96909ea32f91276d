#include "flexura/sim/arm_setup.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "flexura/kinematics/shape.h"
#include "flexura/math/arrays.h"
#include "flexura/mechanics/arm_rod.h"

namespace flexura {
namespace {

std::vector<std::array<double, 2>> tube_radii(const Arm& arm) {
  std::vector<std::array<double, 2>> radii;
  radii.reserve(arm.sections.size());
  for (const Section& section : arm.sections) radii.push_back(section.radius);
  return radii;
}

// Sets the time step, contact, drag and payloads of an arm with inertia.
void set_motion(const RigConfig& config, const Arm& arm, ArmRod& rod) {
  rod.time_step = config.arm.time_step;
  rod.spectral_radius = config.arm.spectral_radius;
  if (const auto& contact = config.arm.contact) {
    rod.contact = {.law = {.stiffness = contact->stiffness,
                           .damping = contact->damping,
                           .friction = contact->friction,
                           .slip_speed = contact->slip_speed},
                   .obstacles = config.obstacles,
                   .X_WB = arm.X_WB,
                   .radii = tube_radii(arm),
                   .itself = contact->itself};
    double least = std::numeric_limits<double>::infinity();
    for (const auto& radius : rod.contact->radii) least = std::min({least, radius[0], radius[1]});
    rod.contact->places = contact_places(rod.rod, contact->spacing.value_or(least));
  }
  if (const auto& drag = config.arm.drag)
    rod.drag = {.density = drag->density,
                .across_coefficient = drag->across_coefficient,
                .along_coefficient = drag->along_coefficient,
                .linear_across = drag->linear_across,
                .linear_along = drag->linear_along,
                .flow = arm.X_WB.rotation.transpose() * vector(drag->flow),
                .radii = tube_radii(arm)};
  for (const PayloadConfig& payload : config.arm.payload)
    rod.payloads.push_back({.payload = {.place = {static_cast<std::size_t>(payload.section - 1), payload.at},
                                        .mass = payload.mass,
                                        .offset = vector(payload.offset)},
                            .from = payload.from,
                            .until = payload.until.value_or(std::numeric_limits<double>::infinity())});
}

}  // namespace

ArmSetup::ArmSetup(const RigConfig& config) : arm(config.arm.arm()) {
  initial = arm_state(arm, config.arm.initial);
  if (config.drive) drive = config.drive->drive();
  if (config.arm.mechanics == ArmMechanics::kinematic) return;
  rod = {.rod = rod_of(config.arm, config.drive), .loads = loads_of(config.arm)};
  for (std::size_t i = 0; i < config.arm.tendon.size(); ++i)
    if (const auto time = config.arm.tendon[i].breaks_at) rod->breaks.push_back({i, *time});
  if (config.arm.mechanics == ArmMechanics::dynamics) set_motion(config, arm, *rod);
}

}  // namespace flexura
