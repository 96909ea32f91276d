#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "flexura/sim/dynamic_plant.h"
#include "flexura/sim/simulated_rig.h"
#include "tests/support/elastic_rigs.h"

// Elastic arms whose tendons have friction and stretch, moved open loop by motors.
namespace flexura {
namespace {

constexpr double coefficient = 0.2, stretching = 2e-4, tension = 8;  // 1, m/N, N

// Two sections with three tendons each, which lose the travel of a capstan. `travel`: as compensated, m/rad.
RigConfig rubbing_rig(double travel) {
  RigConfig rig = elastic_rig();
  rig.arm.mechanics = ArmMechanics::dynamics;
  rig.arm.time_step = 0.02;
  for (Section& section : rig.arm.section) section.material->damping_time = 0.1;
  for (const TendonConfig& tendon : rig.drive->tendon)
    rig.arm.tendon.push_back({.section = tendon.section,
                              .radius = *tendon.radius,
                              .angle = tendon.angle,
                              .compliance = stretching,
                              .friction = coefficient});
  rig.drive->pretension = tension;
  rig.drive->spool.friction_travel = travel;
  return rig;
}

// Moves the arm from straight to `target` and back, and again to it. Returns the tip at half of the bends on
// each of the three ways, m.
std::vector<Eigen::Vector3d> tips_half_way(const RigConfig& config, const ArmState& target) {
  SimulatedRig rig(config, config, numbers_renderer, 1);
  std::vector<Eigen::Vector3d> tips;
  double time = 0;
  const auto move = [&](double from, double to) {
    constexpr int steps = 20;
    for (int i = 1; i <= steps; ++i) {
      ArmState state = target;
      for (Eigen::Vector2d& bend : state.bends) bend *= from + (to - from) * i / steps;
      EXPECT_TRUE(rig.ports().arm->command(state, 0.1));
      rig.clock().wait_until(time += 0.1);
    }
  };
  for (const auto& [from, to] : {std::pair{0.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}}) {
    move(from, 0.5);
    rig.clock().wait_until(time += 1);
    tips.push_back(rig.arm().backbone(time).tip().position);
    move(0.5, to);
  }
  return tips;
}

TEST(TendonFriction, CompensatedMakesTheHysteresisOfAnElasticArmSmaller) {
  ArmState target = ArmState::straight(2);
  target.bends = {{0.8, 0.2}, {0.5, -0.4}};
  const double travel = stretching * coefficient * tension;
  for (const double part : {0.0, 0.5, 1.0, 1.5}) {
    const auto tips = tips_half_way(rubbing_rig(part * travel), target);
    std::printf("%g: hysteresis %.3f mm, loop closes to %.3f mm\n", part, 1e3 * (tips[1] - tips[2]).norm(),
                1e3 * (tips[2] - tips[0]).norm());
  }
}

}  // namespace
}  // namespace flexura
