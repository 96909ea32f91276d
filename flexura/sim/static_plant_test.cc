#include "flexura/sim/static_plant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "flexura/mechanics/arm_rod.h"
#include "flexura/sim/arm_setup.h"
#include "flexura/sim/simulated_rig.h"
#include "flexura/sim/tendon_pull.h"
#include "tests/support/elastic_rigs.h"
#include "tests/support/rigs.h"

namespace flexura {
namespace {

StaticPlant& plant_of(SimulatedRig& rig) { return dynamic_cast<StaticPlant&>(rig.arm().plant()); }

// Without weight and backlash, the rod matches the arcs of the tendons except for its shortening under them,
// about 0.03 mm of 0.5 m. A lever ten times that of a tendon makes this 0.5 mm.
TEST(StaticPlant, WithoutWeightIsTheArcsThatAreBelieved) {
  RigConfig config = elastic_rig();
  config.drive->spool.backlash = 0;
  SimulatedRig rig(config, config, numbers_renderer, 1);
  ASSERT_TRUE(rig.ports().arm->command(bent_state(), 0));
  rig.clock().wait_until(8);
  const ArmState read = rig.ports().arm->read().value().state;
  EXPECT_NEAR(read.bends[0].x(), 0.5, 1e-3);
  const Backbone nominal = ArmModel(config.arm.arm()).backbone(read), truth = rig.arm().backbone(8);
  EXPECT_LE((nominal.tip().position - truth.tip().position).norm(), 1e-3);
  EXPECT_NEAR(truth.rest_length(), 0.5, 1e-12);
}

TEST(StaticPlant, SagsUnderItsWeightWhereThePortSaysThatItDoesNot) {
  const RigConfig nominal = elastic_rig(), heavy = elastic_rig(9.81);
  SimulatedRig rig(nominal, heavy, numbers_renderer, 1);
  ASSERT_TRUE(rig.ports().arm->command(bent_state(), 0));
  rig.clock().wait_until(8);
  const Backbone arcs = ArmModel(nominal.arm.arm()).backbone(rig.ports().arm->read().value().state);
  const Eigen::Vector3d sag = rig.arm().backbone(8).tip().position - arcs.tip().position;
  EXPECT_GT(sag.x(), 2e-3);
  const Equilibrium at = plant_of(rig).equilibrium(8);
  EXPECT_TRUE(at.converged() && at.stable);
  for (const double tension : at.tensions) EXPECT_GE(tension, 0);
}

// Answers do not depend on earlier queries, nor on how the rig's time advanced.
TEST(StaticPlant, AnswersTheSameHoweverItIsAsked) {
  const RigConfig config = elastic_rig(9.81);
  SimulatedRig slow(config, config, numbers_renderer, 1), quick(config, config, numbers_renderer, 1);
  for (SimulatedRig* rig : {&slow, &quick}) ASSERT_TRUE(rig->ports().arm->command(bent_state(), 0));
  for (int i = 1; i <= 100; ++i) {
    slow.clock().wait_until(0.011 * i);
    (void)slow.arm().backbone(0.011 * i);
  }
  quick.clock().wait_until(1.1);
  const double time = 1.093;
  const Eigen::VectorXd q = plant_of(slow).equilibrium(time).q;
  EXPECT_EQ(q, plant_of(quick).equilibrium(time).q);
  std::vector<Eigen::VectorXd> asked(4);
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < 4; ++i)
      threads.emplace_back([&, i] {
        (void)plant_of(quick).equilibrium(1.0 + 0.02 * static_cast<double>(i));
        asked[i] = plant_of(quick).equilibrium(time).q;
      });
  }
  for (const Eigen::VectorXd& same : asked) EXPECT_EQ(same, q);
}

TEST(StaticPlant, WithoutADriveIsPulledAsArcsWouldBe) {
  RigConfig config = elastic_rig();
  for (int i = 0; i < 6; ++i) {
    config.arm.tendon.push_back({.section = i < 3 ? 1 : 2,
                                 .radius = 0.01,
                                 .angle = 2 * std::numbers::pi * i / 3 + (i < 3 ? 0 : 0.5)});
  }
  config.drive.reset();
  SimulatedRig rig(config, config, numbers_renderer, 1);
  ASSERT_TRUE(rig.ports().arm->command(bent_state(), 0));
  rig.clock().wait_until(8);
  const Backbone nominal = ArmModel(config.arm.arm()).backbone(bent_state()), truth = rig.arm().backbone(8);
  EXPECT_LE((nominal.tip().position - truth.tip().position).norm(), 1e-3);
}

// At rest and straight, each tendon has the pretension, and a small bend leaves no tendon slack.
TEST(StaticPlant, BeginsWithItsPretension) {
  RigConfig config = elastic_rig();
  config.drive->pretension = 3;
  SimulatedRig rig(config, config, numbers_renderer, 1);
  for (const double tension : plant_of(rig).tensions(0)) EXPECT_NEAR(tension, 3, 1e-6);
  ArmState little = ArmState::straight(2);
  little.bends[1] = {0.02, 0};
  ASSERT_TRUE(rig.ports().arm->command(little, 0));
  rig.clock().wait_until(3);
  for (const double tension : plant_of(rig).tensions(3)) EXPECT_GT(tension, 0.5);
}

// A motor that cannot hold its tendon turns back by whole turns of its field until it can. Its controller
// keeps counting, and the motor stays behind for good.
TEST(StaticPlant, LosesStepsUnderMoreThanThePullOutTorque) {
  RigConfig config = elastic_rig(), weak = elastic_rig();
  const double most = 1.5;  // N
  weak.drive->motor.pull_out = {{{0, most * 0.01}, {100, 0.5 * most * 0.01}}};
  SimulatedRig strong(config, config, numbers_renderer, 1), rig(config, weak, numbers_renderer, 1);
  for (SimulatedRig* one : {&strong, &rig}) {
    ASSERT_TRUE(one->ports().arm->command(bent_state(), 0));
    one->clock().wait_until(8);
  }
  const std::vector<double> tensions = plant_of(strong).tensions(8), held = plant_of(rig).tensions(8),
                            lost = plant_of(rig).lost_steps(8);
  const double turn = weak.drive->motor.field_turn();
  double all = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_LE(held[i], most + 1e-9) << i;
    EXPECT_EQ(std::remainder(lost[i], turn), 0);
    EXPECT_GE(lost[i], 0);
    all += lost[i];
  }
  EXPECT_GT(*std::ranges::max_element(tensions), most);
  EXPECT_GT(all, 0);
  EXPECT_EQ(rig.ports().arm->read().value().positions, strong.ports().arm->read().value().positions);
  EXPECT_EQ(plant_of(strong).lost_steps(8), std::vector<double>(6, 0.0));
  // Lost steps stay lost.
  ASSERT_TRUE(rig.ports().arm->command(ArmState::straight(2), 0));
  rig.clock().wait_until(16);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_GE(plant_of(rig).lost_steps(16)[i], lost[i]);
}

// An arm with six tendons and no drive.
RigConfig free_rig(double gravity = 0) {
  RigConfig config = elastic_rig(gravity);
  for (int i = 0; i < 6; ++i)
    config.arm.tendon.push_back({.section = i < 3 ? 1 : 2,
                                 .radius = 0.01,
                                 .angle = 2 * std::numbers::pi * i / 3 + (i < 3 ? 0 : 0.5)});
  config.drive.reset();
  return config;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double most) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], most) << i;
}

TEST(StaticPlant, PullsTendonsWhateverBendsWereCommanded) {
  RigConfig config = free_rig();
  for (Section& section : config.arm.section) section.max_bend_rate = 1;
  SimulatedRig rig(config, config, numbers_renderer, 1);
  ASSERT_TRUE(rig.ports().arm->command(bent_state(), 0));
  rig.clock().wait_until(2);
  const std::vector<double> desired = {0.004, -0.001, -0.002, 0.001, 0.0005, 0.002};
  ASSERT_TRUE(rig.arm().pull(desired, 0.5));
  EXPECT_TRUE(rig.ports().arm->read().value().moving);
  rig.clock().wait_until(4);
  EXPECT_FALSE(rig.ports().arm->read().value().moving);
  expect_near(plant_of(rig).pulled(4), desired, 1e-12);
  const Equilibrium at = plant_of(rig).equilibrium(4);
  for (std::size_t i = 0; i < desired.size(); ++i)
    EXPECT_TRUE(at.tensions[i] == 0 || std::abs(at.displacements[i] - desired[i]) < 1e-9) << i;
  // The model's reading is the nearest arcs, and commanded bends take over again.
  const ArmState nearest = nearest_arcs(ArmSetup(config).rod->rod, config.arm.arm(), desired);
  EXPECT_LT((rig.ports().arm->read().value().state.bends[0] - nearest.bends[0]).norm(), 1e-9);
  ASSERT_TRUE(rig.ports().arm->command(bent_state(), 0));
  rig.clock().wait_until(8);
  const std::vector<double> arcs = arc_displacements(ArmSetup(config).rod->rod, bent_state()).pulled;
  expect_near(plant_of(rig).pulled(8), arcs, 1e-12);
}

TEST(StaticPlant, StopsATendonOnItsWay) {
  RigConfig config = free_rig();
  SimulatedRig rig(config, config, numbers_renderer, 1);
  // All tendons of a section pull equally: no bend results, so the motion takes the given time.
  ASSERT_TRUE(rig.arm().pull({2e-6, 2e-6, 2e-6, 0, 0, 0}, 1));
  rig.clock().wait_until(0.5);
  ASSERT_TRUE(rig.ports().arm->halt());
  rig.clock().wait_until(1);
  EXPECT_NEAR(plant_of(rig).pulled(1)[0], 1e-6, 1e-9);
  EXPECT_EQ(plant_of(rig).pulled(0.25)[1], plant_of(rig).pulled(0.25)[0]);
}

TEST(StaticPlant, PullsTendonsByTheirAxes) {
  RigConfig config = elastic_rig();
  SimulatedRig rig(config, config, numbers_renderer, 1);
  const std::vector<double> desired = {0.004, -0.002, -0.002, 0.002, 0, 0.001};
  ASSERT_TRUE(rig.arm().pull(desired, 0));
  EXPECT_TRUE(rig.ports().arm->read().value().moving);
  rig.clock().wait_until(8);
  const double microstep = 1 / config.drive->drive().axes[0].microsteps_a_metre();
  expect_near(plant_of(rig).pulled(8), desired, microstep);
  ASSERT_TRUE(rig.ports().arm->command(ArmState::straight(2), 0));
  rig.clock().wait_until(16);
  expect_near(plant_of(rig).pulled(16), std::vector<double>(6, 0.0), microstep);
}

TEST(StaticPlant, RefusesPullsOfNoTendons) {
  const RigConfig driven = elastic_rig(), free = free_rig(), arcs = two_section_rig();
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const RigConfig& config : {driven, free}) {
    SimulatedRig rig(config, config, numbers_renderer, 1);
    EXPECT_FALSE(rig.arm().pull({0, 0, 0, 0, 0}, 0));
    EXPECT_FALSE(rig.arm().pull({0, 0, 0, 0, 0, none}, 0));
    EXPECT_FALSE(rig.arm().pull({0, 0, 0, 0, 0, 0}, -1));
    EXPECT_FALSE(rig.arm().pull({0, 0, 0, 0, 0, 0}, none));
    EXPECT_TRUE(rig.arm().pull({0, 0, 0, 0, 0, 0}, 0));
  }
  RigConfig bends = arcs;
  bends.drive.reset();
  SimulatedRig rig(bends, bends, numbers_renderer, 1);
  EXPECT_FALSE(rig.arm().pull({0, 0, 0, 0, 0, 0}, 0));
}

TEST(StaticPlant, IsWithoutWeightFromATimeOn) {
  const RigConfig heavy = free_rig(9.81), light = free_rig();
  SimulatedRig rig(heavy, heavy, numbers_renderer, 1), none(light, light, numbers_renderer, 1);
  for (SimulatedRig* one : {&rig, &none}) {
    ASSERT_TRUE(one->ports().arm->command(bent_state(), 0));
    one->clock().wait_until(8.013);
  }
  const auto tip = [](SimulatedRig& one, double time) { return one.arm().backbone(time).tip().position; };
  const Eigen::Vector3d sagged = tip(rig, 8.013), before = tip(rig, 8.005);
  EXPECT_FALSE(plant_of(none).weigh(8.013, false)) << "nothing to switch off";
  ASSERT_TRUE(plant_of(rig).weigh(8.013, false));
  EXPECT_FALSE(plant_of(rig).is_weighed(8.013));
  EXPECT_TRUE(plant_of(rig).is_weighed(8.012));
  EXPECT_LT((tip(rig, 8.013) - tip(none, 8.013)).norm(), 1e-7) << "at once";
  EXPECT_EQ(tip(rig, 8.005), before) << "what was stays as it was";
  rig.clock().wait_until(8.5);
  EXPECT_LT((tip(rig, 8.5) - tip(none, 8.013)).norm(), 1e-7);
  ASSERT_TRUE(plant_of(rig).weigh(8.5, true));
  EXPECT_LT((tip(rig, 8.5) - sagged).norm(), 1e-7);
  EXPECT_EQ(plant_of(rig).warning(8.5), "");
}

// Upright, and so heavy that it cannot stand: it falls to a side, and over to another one as it is sent
// there.
TEST(StaticPlant, SnapsWhereItBucklesAndGoesOn) {
  RigConfig config = free_rig(9.81);
  config.arm.gravity = {0, -9.81, 0};
  for (Section& section : config.arm.section) section.material->density *= 40;
  SimulatedRig rig(config, config, numbers_renderer, 1);
  int snaps = 0, looks = 0;
  for (int way = 0; way < 4; ++way) {
    ArmState state = ArmState::straight(2);
    for (Eigen::Vector2d& bend : state.bends) bend = {way % 2 == 0 ? 0.8 : -0.8, 0.1 * way};
    ASSERT_TRUE(rig.ports().arm->command(state, 0));
    for (int i = 0; i < 40; ++i) {
      rig.clock().wait_until(rig.clock().now() + 0.1);
      const double now = rig.clock().now();
      const Equilibrium at = plant_of(rig).equilibrium(now);
      ASSERT_TRUE(at.converged() && at.stable) << now;
      const std::string warning = plant_of(rig).warning(now);
      EXPECT_EQ(warning.find("is unstable"), std::string::npos) << now;
      snaps += warning.empty() ? 0 : 1, ++looks;
    }
  }
  EXPECT_GT(snaps, 0);
  EXPECT_LT(snaps, looks / 2);
}

TEST(StaticPlant, APullOutTorqueIsBetweenItsPoints) {
  StepperMotor motor;
  EXPECT_EQ(motor.pull_out_torque(10), std::numeric_limits<double>::infinity());
  motor.pull_out = {{{0, 1}, {10, 0.5}, {20, 0.1}}};
  EXPECT_EQ(motor.pull_out_torque(0), 1);
  EXPECT_DOUBLE_EQ(motor.pull_out_torque(5), 0.75);
  EXPECT_DOUBLE_EQ(motor.pull_out_torque(15), 0.3);
  EXPECT_EQ(motor.pull_out_torque(100), 0.1);
}

TEST(StaticPlant, RefusesAnArmWithTooFewTendons) {
  RigConfig config = elastic_rig();
  config.arm.tendon.push_back({.section = 1, .radius = 0.01});
  EXPECT_THROW(SimulatedRig(config, config, numbers_renderer, 1), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
