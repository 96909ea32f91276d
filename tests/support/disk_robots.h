#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// A weightless robot whose tendons run straight between few guide disks, its tensions and a force at its
/// tip.
struct DiskRobot {
  Rod rod;
  std::vector<double> tensions;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();

  [[nodiscard]] RodLoads loads() const {
    if (force.isZero(0)) return {};
    return {.ends = {{.section = rod.sections.size() - 1, .force = force}}};
  }
};

/// Returns a robot of one to three tapered wires with 2 to 8 pieces a section, or as many as given. One of
/// three tendons of each section bends it by up to `most_bend` rad if it pulled alone; others pull against
/// it. Some are helical.
inline DiskRobot random_disk_robot(TestRandom& random, double most_bend, int pieces = 0) {
  DiskRobot robot;
  const int sections = random.integer(1, 3), drawn = random.integer(2, 8);
  const int disks = pieces > 0 ? pieces : drawn;
  const double radius = random.uniform(0.005, 0.02);
  for (int i = 0; i < sections; ++i) {
    RodSection section{.length = random.uniform(0.1, 0.3)};
    section.radius = {random.uniform(0.6e-3, 1.2e-3), random.uniform(0.6e-3, 1.2e-3)};
    section.youngs_modulus = 50e9;
    section.shear_modulus = 20e9;
    section.disks = disks;
    robot.rod.sections.push_back(section);
    const double angle = random.uniform(-3, 3), tension = random.uniform(0, most_bend) / section.length *
                                                          section.stiffness_at(0.5)[3] / radius;
    for (int k = 0; k < 3; ++k) {
      TendonRoute tendon{
          .section = static_cast<std::size_t>(i), .radius = radius, .angle = angle + 2.0944 * k};
      if (random.integer(0, 2) == 0) tendon.angle_slope = random.uniform(-2, 2);
      robot.rod.tendons.push_back(tendon);
      const bool opposes = k == 1 && random.integer(0, 1) == 0;
      robot.tensions.push_back(k == 0 ? tension : (opposes ? random.uniform(0, 0.3) * tension : 0.0));
    }
  }
  if (random.integer(0, 1) == 0)
    robot.force = random.vector<3>(-0.3, 0.3) * robot.tensions[0] * radius / robot.rod.length();
  return robot;
}

/// Returns the largest angle between a section's ends, rad, of a placed rod.
inline double largest_section_bend(const RodChain& chain) {
  double most = 0;
  Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  for (std::size_t i = 0; i < chain.rod().sections.size(); ++i) {
    const Eigen::Vector3d end = chain.pose(chain.node_of({i, 1})).rotation.col(2);
    most = std::max(most, std::atan2(z.cross(end).norm(), z.dot(end)));
    z = end;
  }
  return most;
}

}  // namespace flexura
