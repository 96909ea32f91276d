#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdio>
#include <optional>

#include "flexura/model/arm_model.h"
#include "flexura/sim/simulated_rig.h"
#include "tests/support/elastic_rigs.h"

// Elastic arms whose tendons have friction and stretch, moved open loop by motors.
namespace flexura {
namespace {

struct RubbingTendons {
  double friction = 0;
  double compliance = 0;  // m/N
  double tension = 0;     // N

  // Returns the lost travel of a tendon between motor and arm, m/rad.
  [[nodiscard]] double travel() const { return compliance * friction * tension; }
};

// Two sections with three tendons each. `travel`: as compensated, m/rad.
RigConfig rubbing_rig(const RubbingTendons& tendons, std::optional<double> travel) {
  RigConfig rig = elastic_rig();
  rig.arm.mechanics = ArmMechanics::dynamics;
  rig.arm.time_step = 0.04;
  for (Section& section : rig.arm.section) section.material->damping_time = 0.1;
  for (const TendonConfig& tendon : rig.drive->tendon)
    rig.arm.tendon.push_back({.section = tendon.section,
                              .radius = tendon.radius.value(),
                              .angle = tendon.angle,
                              .compliance = tendons.compliance,
                              .friction = tendons.friction});
  rig.drive->pretension = tendons.tension;
  rig.drive->spool.friction_travel = travel;
  return rig;
}

ArmState bent_by(double part) {
  ArmState state = ArmState::straight(2);
  state.bends = {part * Eigen::Vector2d(0.8, 0), part * Eigen::Vector2d(0.5, 0)};
  return state;
}

// Difference of the tip at one commanded shape: reached by bending minus reached by straightening.
struct Hysteresis {
  double position = 0;   // m
  double direction = 0;  // rad
  double along = 0;      // Part of `position` away from the straight arm, m.
};

Hysteresis hysteresis(const RubbingTendons& tendons, std::optional<double> travel) {
  const RigConfig config = rubbing_rig(tendons, travel);
  SimulatedRig rig(config, config, numbers_renderer, 1);
  double time = 0;
  const auto move = [&](double from, double to) {
    const int steps = static_cast<int>(std::lround(std::abs(to - from) / 0.05));
    for (int i = 1; i <= steps; ++i) {
      EXPECT_TRUE(rig.ports().arm->command(bent_by(from + (to - from) * i / steps), 0.1));
      rig.clock().wait_until(time += 0.1);
    }
  };
  const auto tip_at_rest = [&] {
    rig.clock().wait_until(time += 0.8);
    return rig.arm().backbone(time).tip();
  };
  move(0, 1);
  move(1, 0.5);
  const Pose straightened = tip_at_rest();
  move(0.5, 0.1);
  move(0.1, 0.5);
  const Pose bent = tip_at_rest();
  const ArmModel arcs(config.arm.arm());
  const Eigen::Vector3d way =
      arcs.backbone(bent_by(0.5)).tip().position - arcs.backbone(bent_by(0)).tip().position;
  const Eigen::Vector3d moved = bent.position - straightened.position;
  return {moved.norm(), (bent.rotation.col(2) - straightened.rotation.col(2)).norm(),
          moved.dot(way.normalized())};
}

void print(const char* what, const Hysteresis& one) {
  std::printf("%s: position %.1f mm, direction %.1f mrad\n", what, 1e3 * one.position, 1e3 * one.direction);
}

// The spools determine the sum of the bends, and so the direction of the tip. The friction within the arm
// also makes the bends uneven, which moves the tip to the other side.
TEST(TendonFriction, CompensatedTurnsTheTipAlikeOnBothWays) {
  const RubbingTendons tendons{.friction = 0.2, .compliance = 1e-3, .tension = 4};
  const Hysteresis without = hysteresis(tendons, std::nullopt), with = hysteresis(tendons, tendons.travel());
  print("without compensation", without);
  print("with compensation", with);
  EXPECT_GT(without.direction, 0.05);
  EXPECT_LT(with.direction, 0.25 * without.direction);
  EXPECT_GT(with.position, without.position) << "docs/drives.md names this limit";
}

// As in docs/laboratory.md: the value is adjusted until the tip comes to the same place on both ways.
TEST(TendonFriction, CompensatedAsMeasuredBringsTheTipToTheSamePlaceOnBothWays) {
  const RubbingTendons tendons{.friction = 0.1, .compliance = 1e-2, .tension = 1};
  const double trial = 0.5 * tendons.travel();
  const Hysteresis without = hysteresis(tendons, std::nullopt), tried = hysteresis(tendons, trial);
  ASSERT_LT(without.along, 0) << "the tip lags";
  ASSERT_GT(tried.along, 0);
  const double measured = trial * without.along / (without.along - tried.along);
  const Hysteresis with = hysteresis(tendons, measured);
  std::printf("measured: %.3f mm/rad, %.2f of the closed form\n", 1e3 * measured,
              measured / tendons.travel());
  print("without compensation", without);
  print("with compensation", with);
  EXPECT_LT(with.position, 0.5 * without.position);
  EXPECT_LT(with.direction, 0.9 * without.direction);
}

}  // namespace
}  // namespace flexura
