#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// Returns a rod of one to three tapered sections, curved at rest, with straight, helical and converging
/// tendons. Its size is typical of a laboratory: sections of 0.1 to 0.3 m that tendon tensions of a few
/// newtons bend by up to a turn.
inline Rod random_rod(TestRandom& random, double friction = 0) {
  Rod rod;
  const int sections = random.integer(1, 3);
  for (int i = 0; i < sections; ++i) {
    RodSection section{.length = random.uniform(0.1, 0.3)};
    section.radius = {random.uniform(0.6e-3, 1.2e-3), random.uniform(0.6e-3, 1.2e-3)};
    if (random.integer(0, 2) == 0) section.inner_radius = {0.3e-3, 0.2e-3};
    section.youngs_modulus = random.uniform(30e9, 120e9);
    section.shear_modulus = section.youngs_modulus / (2 * (1 + random.uniform(0.1, 0.5)));
    section.density = random.uniform(2000, 8000);
    if (random.integer(0, 1) == 0)
      section.rest_curvature = {random.vector<3>(-3.0, 3.0), random.vector<3>(-2.0, 2.0)};
    if (random.integer(0, 2) == 0)
      section.masses = {{.at = random.uniform(0.2, 1),
                         .mass = random.uniform(0, 0.01),
                         .offset = random.vector<3>(-0.01, 0.01)}};
    rod.sections.push_back(section);
  }
  const double length = rod.length();
  for (int end = 0; end < sections; ++end) {
    const int count = random.integer(1, 4);
    for (int i = 0; i < count; ++i) {
      TendonRoute tendon{.section = static_cast<std::size_t>(end), .radius = random.uniform(0.004, 0.012)};
      tendon.angle = random.uniform(-std::numbers::pi, std::numbers::pi);
      const int kind = random.integer(0, 3);
      if (kind == 1) tendon.angle_slope = random.uniform(-6, 6) / length;
      if (kind == 2) tendon.radius_slope = random.uniform(-0.8, 0.3) * tendon.radius / length;
      if (kind == 3) {
        tendon.x = {random.uniform(-0.003, 0.003), random.uniform(-0.01, 0.01)};
        tendon.y = {0, random.uniform(-0.01, 0.01), random.uniform(-0.05, 0.05)};
      }
      tendon.friction = friction > 0 ? random.uniform(0, friction) : 0;
      rod.tendons.push_back(tendon);
    }
  }
  return rod;
}

/// Returns random tensions, N. Most are zero, as in a bending robot.
inline std::vector<double> random_tensions(TestRandom& random, const Rod& rod, double most) {
  std::vector<double> tensions(rod.tendons.size(), 0.0);
  for (double& tension : tensions)
    if (random.integer(0, 2) == 0) tension = random.uniform(0, most);
  return tensions;
}

inline RodLoads random_loads(TestRandom& random, const Rod& rod) {
  RodLoads loads;
  if (random.integer(0, 1) == 0) loads.gravity = 9.81 * random.vector<3>(-1.0, 1.0).normalized();
  if (random.integer(0, 2) == 0) loads.per_length = random.vector<3>(-0.1, 0.1);
  if (random.integer(0, 1) == 0) {
    EndLoad end{
        .section = static_cast<std::size_t>(random.integer(0, static_cast<int>(rod.sections.size()) - 1)),
        .force = random.vector<3>(-0.15, 0.15)};
    if (random.integer(0, 1) == 0) end.moment = random.vector<3>(-0.01, 0.01);
    end.following = random.integer(0, 2) == 0;
    loads.ends.push_back(end);
  }
  return loads;
}

}  // namespace flexura
