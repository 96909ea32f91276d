// Arms that are pushed.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "flexura/sim/dynamic_plant.h"
#include "flexura/sim/simulated_rig.h"
#include "flexura/sim/static_plant.h"
#include "tests/support/elastic_rigs.h"
#include "tests/support/rigs.h"

namespace flexura {
namespace {

RigConfig pushed_rig(ArmMechanics mechanics) {
  RigConfig rig = elastic_rig(9.81);
  rig.arm.mechanics = mechanics;
  for (Section& section : rig.arm.section) section.material->damping_time = 0.05;
  return rig;
}

struct PushedRig {
  explicit PushedRig(ArmMechanics mechanics)
      : config(pushed_rig(mechanics)), rig(config, config, numbers_renderer, 1) {}
  [[nodiscard]] Plant& plant() { return rig.arm().plant(); }
  [[nodiscard]] Eigen::Vector3d tip(double time) { return plant().backbone(time).tip().position; }
  void go_to(double time) { rig.clock().wait_until(time); }

  RigConfig config;
  SimulatedRig rig;
};

// A push sideways, at a point within the second section.
PlantPush aside(const Eigen::Vector3d& tip) {
  return {.s_rest = 0.4, .to = tip + Eigen::Vector3d(0.02, 0, 0.2), .stiffness = 1, .most = 2};
}

TEST(Push, BringsAnArmAtRestElsewhereUntilItIsReleased) {
  PushedRig arm(ArmMechanics::statics);
  const Eigen::Vector3d rest = arm.tip(0);
  EXPECT_FALSE(arm.plant().pushed(0));
  ASSERT_TRUE(arm.plant().push(0, aside(rest)));
  EXPECT_EQ(arm.plant().pushed(0).value(), aside(rest));
  arm.go_to(0.1);
  EXPECT_GT((arm.tip(0.1) - rest).norm(), 2e-3);
  EXPECT_EQ(arm.plant().warning(0.1), "");
  const PlantPushForce force = arm.plant().push_force(0.1).value();
  EXPECT_EQ(force.s_rest, 0.4);
  EXPECT_GT(force.force.z(), 0.03);
  EXPECT_LE(force.force.norm(), 2);
  // The same force without a spring holds the arm there.
  arm.plant().push(0.1, PlantPush{.s_rest = 0.4, .force = force.force});
  arm.go_to(0.2);
  EXPECT_LE((arm.plant().push_force(0.2).value().point - force.point).norm(), 1e-4);
  arm.plant().push(0.2, std::nullopt);
  arm.go_to(0.3);
  EXPECT_FALSE(arm.plant().push_force(0.3));
  EXPECT_LE((arm.tip(0.3) - rest).norm(), 1e-6);
}

TEST(Push, LetsAnArmInMotionSwingAndSettleAndSwingBack) {
  PushedRig arm(ArmMechanics::dynamics), still(ArmMechanics::statics);
  const Eigen::Vector3d rest = arm.tip(0);
  arm.plant().push(0, aside(rest));
  still.plant().push(0, aside(rest));
  arm.go_to(0.05);
  EXPECT_GT(arm.plant().energy(0.05).value().kinetic, 1e-6);
  arm.go_to(8), still.go_to(8);
  EXPECT_LE((arm.tip(8) - still.tip(8)).norm(), 2e-4) << "where it is at rest";
  arm.plant().push(8, std::nullopt);
  double greatest = 0;
  for (int i = 1; i <= 20; ++i) {
    arm.go_to(8 + 0.01 * i);
    greatest = std::max(greatest, arm.plant().energy(8 + 0.01 * i).value().kinetic);
  }
  EXPECT_GT(greatest, 1e-6);
  arm.go_to(16);
  EXPECT_LE(arm.plant().energy(16).value().kinetic, 1e-3 * greatest);
  EXPECT_LE((arm.tip(16) - rest).norm(), 2e-4);
}

// Answers do not depend on earlier queries.
TEST(Push, IsTheSameHoweverItIsAsked) {
  for (const ArmMechanics mechanics : {ArmMechanics::statics, ArmMechanics::dynamics}) {
    PushedRig slow(mechanics), quick(mechanics);
    const PlantPush first = aside(slow.tip(0));
    PlantPush second = first;
    second.s_rest = 0.25;
    for (PushedRig* each : {&slow, &quick}) {
      each->go_to(0.0113);
      each->plant().push(0.0113, first);
      for (int i = 1; i <= 10; ++i) {
        each->go_to(0.0113 + 0.011 * i);
        if (each == &slow) (void)each->tip(0.0113 + 0.011 * i);
      }
      each->plant().push(0.1213, second);
      if (each == &slow) (void)each->tip(0.12);
      each->go_to(0.31);
    }
    EXPECT_EQ(slow.tip(0.3091), quick.tip(0.3091));
  }
}

TEST(Push, IsRefusedWhereItCannotBe) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ArmMechanics mechanics : {ArmMechanics::statics, ArmMechanics::dynamics}) {
    PushedRig arm(mechanics);
    for (const PlantPush& bad :
         {PlantPush{.s_rest = 0.6}, PlantPush{.s_rest = -0.1}, PlantPush{.s_rest = nan},
          PlantPush{.force = {0, nan, 0}}, PlantPush{.to = {nan, 0, 0}}, PlantPush{.stiffness = -1},
          PlantPush{.stiffness = nan}, PlantPush{.most = 0}})
      EXPECT_THROW(arm.plant().push(0, bad), std::invalid_argument);
    EXPECT_FALSE(arm.plant().pushed(0));
  }
  PushedRig arcs(ArmMechanics::kinematic);
  EXPECT_FALSE(arcs.plant().push(0, PlantPush{}));
}

}  // namespace
}  // namespace flexura
