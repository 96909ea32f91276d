#pragma once

#include "flexura/sim/rig_config.h"
#include "tests/support/rigs.h"

namespace flexura {

/// Returns a rig of two sections as a thin steel rod; gravity along the world's -Y. The default is
/// weightless.
inline RigConfig elastic_rig(double gravity = 0) {
  RigConfig rig = two_section_rig();
  for (Section& section : rig.arm.section) {
    MaterialConfig& material = section.material.emplace();
    material.youngs_modulus = 54e9, material.density = 6500, material.radius = {7e-4, 7e-4};
  }
  rig.arm.mechanics = ArmMechanics::statics;
  rig.arm.gravity = {gravity, 0, 0};
  for (TendonConfig& tendon : rig.drive->tendon) tendon.radius = 0.01;
  return rig;
}

/// Returns a bent state for elastic_rig().
inline ArmState bent_state() {
  ArmState state = ArmState::straight(2);
  state.bends = {{0.5, 0.2}, {-0.3, 0.4}};
  return state;
}

}  // namespace flexura
