#include "flexura/sim/dynamic_plant.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "flexura/sim/simulated_rig.h"
#include "flexura/sim/simulation_error.h"
#include "flexura/sim/static_plant.h"
#include "tests/support/elastic_rigs.h"

namespace flexura {
namespace {

RigConfig moving_rig(double gravity, double damping_time = 0.02) {
  RigConfig rig = elastic_rig(gravity);
  rig.arm.mechanics = ArmMechanics::dynamics;
  for (Section& section : rig.arm.section) section.material->damping_time = damping_time;
  return rig;
}

DynamicPlant& moving_plant(SimulatedRig& rig) { return dynamic_cast<DynamicPlant&>(rig.arm().plant()); }

Eigen::Vector3d moving_tip(SimulatedRig& rig, double time) { return rig.arm().backbone(time).tip().position; }

TEST(DynamicPlant, StaysWhereItIsAtRest) {
  const RigConfig config = moving_rig(9.81), still = elastic_rig(9.81);
  SimulatedRig rig(config, config, numbers_renderer, 1), reference(still, still, numbers_renderer, 1);
  const Eigen::Vector3d rest = moving_tip(reference, 0);
  EXPECT_LE((moving_tip(rig, 0) - rest).norm(), 1e-9);
  rig.clock().wait_until(0.5);
  EXPECT_LE((moving_tip(rig, 0.5) - rest).norm(), 1e-8);
  EXPECT_LE(moving_plant(rig).energy(0.5).value().kinetic, 1e-12);
}

TEST(DynamicPlant, SwingsAndSettlesWhereTheArmIsAtRest) {
  const RigConfig config = moving_rig(9.81), still = elastic_rig(9.81);
  SimulatedRig rig(config, config, numbers_renderer, 1), reference(still, still, numbers_renderer, 1);
  for (SimulatedRig* each : {&rig, &reference}) {
    ASSERT_TRUE(each->ports().arm->command(bent_state(), 0));
    each->clock().wait_until(12);
  }
  EXPECT_LE((moving_tip(rig, 12) - moving_tip(reference, 12)).norm(), 1e-4);
  EXPECT_EQ(moving_plant(rig).tensions(12).size(), 6U);
}

// Without damping, the arm keeps swinging after the weight is removed, and keeps all of its energy.
TEST(DynamicPlant, KeepsItsEnergyWhereNothingTakesIt) {
  RigConfig config = moving_rig(9.81, 0);
  config.arm.time_step = 0.001;
  config.arm.spectral_radius = 1;
  config.drive.reset();  // Tendons that become taut again take energy.
  SimulatedRig rig(config, config, numbers_renderer, 1);
  const Eigen::Vector3d start = moving_tip(rig, 0);
  DynamicPlant& plant = moving_plant(rig);
  ASSERT_TRUE(plant.weigh(0, false));
  rig.clock().wait_until(0.3);
  double farthest = 0, greatest = 0, least_sum = 1e9, greatest_sum = -1e9;
  for (int i = 1; i <= 30; ++i) {
    farthest = std::max(farthest, (moving_tip(rig, 0.01 * i) - start).norm());
    const RodEnergy energy = plant.energy(0.01 * i).value();
    greatest = std::max(greatest, energy.kinetic);
    least_sum = std::min(least_sum, energy.total()), greatest_sum = std::max(greatest_sum, energy.total());
  }
  EXPECT_GT(farthest, 2e-3);
  EXPECT_GT(greatest, 0);
  EXPECT_LE(greatest_sum - least_sum, 0.01 * greatest);
}

// Answers do not depend on earlier queries, nor on how the rig's time advanced.
TEST(DynamicPlant, AnswersTheSameHoweverItIsAsked) {
  const RigConfig config = moving_rig(9.81);
  SimulatedRig slow(config, config, numbers_renderer, 1), quick(config, config, numbers_renderer, 1);
  for (SimulatedRig* rig : {&slow, &quick}) ASSERT_TRUE(rig->ports().arm->command(bent_state(), 0));
  for (int i = 1; i <= 100; ++i) {
    slow.clock().wait_until(0.011 * i);
    (void)slow.arm().backbone(0.011 * i);
  }
  quick.clock().wait_until(1.1);
  const double time = 1.0933;
  const Eigen::Vector3d there = moving_tip(slow, time);
  EXPECT_EQ(there, moving_tip(quick, time));
  std::vector<Eigen::Vector3d> asked(4);
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < 4; ++i)
      threads.emplace_back([&, i] {
        (void)moving_tip(quick, 1.0 + 0.02 * static_cast<double>(i));
        asked[i] = moving_tip(quick, time);
      });
  }
  for (const Eigen::Vector3d& same : asked) EXPECT_EQ(same, there);
}

// Half the step gives a quarter of the error.
TEST(DynamicPlant, ConvergesWithItsStep) {
  const auto tip = [](double step) {
    RigConfig config = moving_rig(9.81);
    config.arm.time_step = step;
    SimulatedRig rig(config, config, numbers_renderer, 1);
    EXPECT_TRUE(rig.ports().arm->command(bent_state(), 0));
    rig.clock().wait_until(0.4);
    return moving_tip(rig, 0.4);
  };
  const Eigen::Vector3d fine = tip(0.0005);
  const double coarse = (tip(0.008) - fine).norm(), half = (tip(0.004) - fine).norm();
  EXPECT_LE(half, coarse / 2);
  EXPECT_LE(half, 1e-3);
}

// Within a step, the shape is interpolated once the step's end is known: as accurate as the steps.
TEST(DynamicPlant, IsAsAccurateBetweenStepsAsAtThem) {
  const auto tip = [](double step, double until, double time) {
    RigConfig config = moving_rig(9.81);
    config.arm.time_step = step;
    SimulatedRig rig(config, config, numbers_renderer, 1);
    EXPECT_TRUE(rig.ports().arm->command(bent_state(), 0));
    rig.clock().wait_until(until);
    return moving_tip(rig, time);
  };
  const Eigen::Vector3d fine = tip(0.0005, 0.4, 0.398);
  // 0.398 s is amid a step of 8 or 4 ms.
  const double coarse = (tip(0.008, 0.4, 0.396) - tip(0.0005, 0.4, 0.396)).norm(),
               half = (tip(0.004, 0.4, 0.398) - fine).norm();
  EXPECT_LE(half, coarse);
  // Before and after the step's end is known.
  EXPECT_LE((tip(0.004, 0.398, 0.398) - tip(0.004, 0.4, 0.398)).norm(), half + 1e-6);
}

// The arm falls on an obstacle below it; obstacle and tendons carry its weight.
TEST(DynamicPlant, RestsOnWhatItTouches) {
  RigConfig config = moving_rig(9.81, 0.05);
  SimulatedRig free(config, config, numbers_renderer, 1);
  const Eigen::Vector3d hanging = moving_tip(free, 0);
  config.arm.contact = ContactConfig{.stiffness = 1e4, .spacing = 0.02};
  // Just above where the tip would hang; gravity acts along +X.
  config.obstacles = {
      PlaneConfig{.name = "wall", .point = {hanging.x() + 0.018, 0, 0}, .normal = {-1, 0, 0}}};
  SimulatedRig rig(config, config, numbers_renderer, 1);
  rig.clock().wait_until(3);
  const std::vector<PlantContact> contacts = moving_plant(rig).contacts(3);
  ASSERT_FALSE(contacts.empty());
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const PlantContact& contact : contacts) {
    EXPECT_EQ(contact.with, "wall");
    EXPECT_FALSE(contact.is_deep);
    force += contact.force;
  }
  EXPECT_LT(force.x(), 0);
  EXPECT_LT(moving_tip(rig, 3).x(), hanging.x());
  EXPECT_EQ(moving_plant(rig).warning(3), "");
}

TEST(DynamicPlant, CarriesAPayloadForATime) {
  RigConfig config = moving_rig(9.81, 0.2);
  config.arm.payload = {{.section = 2, .mass = 0.02, .from = 0.5, .until = 3}};
  SimulatedRig rig(config, config, numbers_renderer, 1);
  const double before = moving_tip(rig, 0).x();
  rig.clock().wait_until(2.99);
  const double loaded = moving_tip(rig, 2.99).x();
  EXPECT_GT(loaded, before + 1e-3);
  rig.clock().wait_until(6);
  EXPECT_NEAR(moving_tip(rig, 6).x(), before, 2e-4);
  // Another rig that is queried at other times gives the same answers.
  SimulatedRig other(config, config, numbers_renderer, 1);
  other.clock().wait_until(3.3);
  (void)moving_tip(other, 2.5);
  SimulatedRig again(config, config, numbers_renderer, 1);
  again.clock().wait_until(3.3);
  EXPECT_EQ(moving_tip(other, 3.1), moving_tip(again, 3.1));
}

TEST(DynamicPlant, IsLetGoByATendonThatBreaks) {
  RigConfig config = moving_rig(0, 0.05);
  for (const TendonConfig& tendon : config.drive->tendon)
    config.arm.tendon.push_back({.section = tendon.section, .radius = 0.01, .angle = tendon.angle});
  RigConfig broken = config;
  for (TendonRouteConfig& tendon : broken.arm.tendon) tendon.breaks_at = 4.0;
  SimulatedRig rig(config, broken, numbers_renderer, 1);
  ASSERT_TRUE(rig.ports().arm->command(bent_state(), 0));
  rig.clock().wait_until(3.9);
  const Eigen::Vector3d bent = moving_tip(rig, 3.9);
  rig.clock().wait_until(12);
  const Eigen::Vector3d straight = ArmModel(config.arm.arm()).backbone(ArmState::straight(2)).tip().position;
  EXPECT_GT((bent - straight).norm(), 0.03);
  EXPECT_LE((moving_tip(rig, 12) - straight).norm(), 1e-3);
  for (const double tension : moving_plant(rig).tensions(12)) EXPECT_EQ(tension, 0);
}

// Events inside a step happen at their own times: the step is cut there.
TEST(DynamicPlant, PicksUpAndBreaksInsideAStep) {
  RigConfig config = moving_rig(9.81, 0.05);
  config.arm.time_step = 0.008;
  config.drive->pretension = 2;
  for (const TendonConfig& tendon : config.drive->tendon)
    config.arm.tendon.push_back({.section = tendon.section, .radius = 0.01, .angle = tendon.angle});
  // 0.5 ms before the end of a step.
  const double inside = 0.3195, before = 0.319, after = 0.3199, mass = 0.02;
  config.arm.tendon[0].breaks_at = inside;
  config.arm.payload = {{.section = 2, .mass = mass, .from = inside}};
  SimulatedRig rig(config, config, numbers_renderer, 1), quick(config, config, numbers_renderer, 1);
  for (SimulatedRig* each : {&rig, &quick}) ASSERT_TRUE(each->ports().arm->command(bent_state(), 0));
  rig.clock().wait_until(after);
  DynamicPlant& plant = moving_plant(rig);
  EXPECT_GT(plant.tensions(before)[0], 0);
  EXPECT_EQ(plant.tensions(after)[0], 0);
  const double weight = mass * 9.81 * std::abs(moving_tip(rig, after).x());
  ASSERT_GT(weight, 1e-4);
  EXPECT_NEAR(std::abs(plant.energy(after)->gravity - plant.energy(before)->gravity), weight, 0.3 * weight);
  // Several steps later it agrees with a rig that was queried at the ends of steps only.
  rig.clock().wait_until(0.4);
  quick.clock().wait_until(0.4);
  EXPECT_EQ(moving_tip(rig, 0.4), moving_tip(quick, 0.4));
}

// A motor that cannot hold its tendon loses steps as its rotor model predicts, whatever the steps are.
TEST(DynamicPlant, LosesAsManyStepsHoweverTimeIsCut) {
  const auto lost = [](double step) {
    RigConfig config = moving_rig(9.81, 0.05), weak = config;
    const double most = 1.0;  // N
    weak.drive->motor.pull_out = {{{0, most * 0.01}, {100, 0.5 * most * 0.01}}};
    config.arm.time_step = weak.arm.time_step = step;
    SimulatedRig rig(config, weak, numbers_renderer, 1);
    EXPECT_TRUE(rig.ports().arm->command(bent_state(), 0));
    rig.clock().wait_until(3);
    for (const double tension : moving_plant(rig).tensions(3)) EXPECT_LE(tension, 1.05 * most);
    return moving_plant(rig).lost_steps(3);
  };
  const double turn = elastic_rig().drive->motor.field_turn();
  const std::vector<double> coarse = lost(0.01), fine = lost(0.002);
  double all = 0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    EXPECT_EQ(std::remainder(fine[i], turn), 0);
    EXPECT_NEAR(coarse[i], fine[i], turn) << i;
    all += fine[i];
  }
  EXPECT_GE(all, 2 * turn);
}

RigConfig rubbing_rig(RigConfig config, double friction) {
  for (const TendonConfig& tendon : config.drive->tendon)
    config.arm.tendon.push_back(
        {.section = tendon.section, .radius = 0.01, .angle = tendon.angle, .friction = friction});
  return config;
}

// With friction, an arm pulled in slowly rests where the static arm with pulled-in tendons does. It differs
// from an arm without friction.
TEST(DynamicPlant, RubsAsTheArmAtRestDoes) {
  const auto tip = [](const RigConfig& config) {
    SimulatedRig rig(config, config, numbers_renderer, 1);
    EXPECT_TRUE(rig.ports().arm->command(bent_state(), 4));
    rig.clock().wait_until(8);
    return std::pair(moving_tip(rig, 8), rig.arm().plant().tensions(8));
  };
  const double friction = 0.2;
  const auto [moving, pulls] = tip(rubbing_rig(moving_rig(0, 0.2), friction));
  const auto [known, tensions] = tip(rubbing_rig(elastic_rig(), friction));
  const auto [smooth, least] = tip(rubbing_rig(elastic_rig(), 0));
  EXPECT_LE((moving - known).norm(), 1e-3);
  const double most = *std::ranges::max_element(tensions);
  EXPECT_GT(most, 1.02 * *std::ranges::max_element(least));
  for (std::size_t i = 0; i < pulls.size(); ++i) EXPECT_NEAR(pulls[i], tensions[i], 0.1 * most) << i;
}

// Sections that commands lengthen.
TEST(DynamicPlant, IsDrivenLonger) {
  const auto rig_of = [](const RigConfig& config) {
    RigConfig free = rubbing_rig(config, 0);
    free.drive.reset();
    for (Section& section : free.arm.section)
      section.stretch_limits = {1, 1.3}, section.max_stretch_rate = 0.5;
    return free;
  };
  const RigConfig moving = rig_of(moving_rig(9.81, 0.2)), still = rig_of(elastic_rig(9.81));
  ArmState longer = bent_state();
  longer.stretches = {1.2, 1.1};
  SimulatedRig rig(moving, moving, numbers_renderer, 1), reference(still, still, numbers_renderer, 1);
  for (SimulatedRig* each : {&rig, &reference}) {
    ASSERT_TRUE(each->ports().arm->command(longer, 0));
    each->clock().wait_until(0.2);
    if (each == &rig) {
      EXPECT_GT(moving_plant(rig).energy(0.2).value().kinetic, 1e-6);
    }
    each->clock().wait_until(6);
  }
  EXPECT_NEAR(rig.arm().backbone(6).tip().position.norm(), reference.arm().backbone(6).tip().position.norm(),
              1e-3);
  EXPECT_LE((moving_tip(rig, 6) - moving_tip(reference, 6)).norm(), 1e-3);
}

TEST(DynamicPlant, RefusesToBeginWhereThereIsNoRest) {
  RigConfig config = moving_rig(9.81);
  config.arm.load.push_back({.section = 2, .force = {0, -1e9, 0}, .following = true});
  EXPECT_THROW(SimulatedRig(config, config, numbers_renderer, 1), SimulationError);
}

}  // namespace
}  // namespace flexura
