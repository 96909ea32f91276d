#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/mechanics/rod.h"

namespace flexura {

/// Returns a robot of two sections of 0.2 m and six tendons: E 54 GPa, nu 0.3, radius 0.7 mm. Three tendons
/// 10 mm off axis at 90, -30 and 210 degrees end at the first section, three more at the second.
inline Rod two_section_robot() {
  RodSection section{
      .length = 0.2, .radius = {0.7e-3, 0.7e-3}, .youngs_modulus = 54e9, .shear_modulus = 54e9 / 2.6};
  Rod rod{.sections = {section, section}, .tendons = {}};
  for (const std::size_t end : {0u, 1u})
    for (const double angle : {90.0, -30.0, 210.0})
      rod.tendons.push_back({.section = end, .radius = 0.01, .angle = angle * std::numbers::pi / 180});
  return rod;
}

/// Returns a spring steel rod of 0.5 m with one tendon at 0 degrees.
inline Rod heavy_rod() {
  return {.sections = {RodSection{.length = 0.5,
                                  .radius = {1e-3, 1e-3},
                                  .youngs_modulus = 200e9,
                                  .shear_modulus = 80e9,
                                  .density = 8000}},
          .tendons = {{.section = 0, .radius = 15.06e-3}}};
}

/// Returns a soft tentacle of 0.6 m with internal viscosity and weight, clamped at its side: its z is
/// horizontal and its x points up.
inline Rod soft_tentacle() {
  const double inertia = std::numbers::pi / 4 * std::pow(0.03, 4);
  RodSection section{.length = 0.6,
                     .radius = {0.03, 0.03},
                     .youngs_modulus = 1e6,
                     .shear_modulus = 1e6 / 3,
                     .density = 1000,
                     .damping_time = 0.02 / (1e6 * inertia)};
  section.modes = {.shear = 0, .stretch = 0, .bend = 4, .twist = 0};
  return {.sections = {section}, .tendons = {}};
}
inline RodLoads soft_tentacle_weight() { return {.gravity = {-9.81, 0, 0}}; }

/// Returns a soft arm of 0.3 m with half thickness 8 mm; a second arm has a tendon towards x.
inline Rod soft_arm(double youngs_modulus = 5e6, int bend = 4) {
  RodSection section{.length = 0.3,
                     .radius = {0.008, 0.008},
                     .youngs_modulus = youngs_modulus,
                     .shear_modulus = youngs_modulus / 3,
                     .density = 1100,
                     .damping_time = 0.01};
  section.modes = {.shear = 1, .stretch = 1, .bend = bend, .twist = 1};
  return {.sections = {section}, .tendons = {}};
}
inline Rod soft_arm_with_tendon(double youngs_modulus) {
  Rod rod = soft_arm(youngs_modulus, 8);
  rod.tendons = {{.section = 0, .radius = 0.007, .angle = 0}};
  return rod;
}

/// Returns a rod of length 1 with EI = 1 that can only bend.
inline Rod elastica(int modes) {
  RodSection section{.length = 1, .stiffness = Vector6d::Ones(), .mass_per_length = 1};
  section.modes = {.shear = 0, .stretch = 0, .bend = modes, .twist = 0};
  return {.sections = {section}, .tendons = {}};
}

}  // namespace flexura
