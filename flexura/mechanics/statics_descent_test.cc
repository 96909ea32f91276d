#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/mechanics/statics.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/upright_arms.h"

namespace flexura {
namespace {

// Larger test: statics_full_test.cc.
TEST(StaticsDescent, SoftUprightArmsComeToAStableRest) {
  for_random_cases(25, [](TestRandom& random) { expect_upright_arm_rests(random); });
}

// The arm of examples/10_sagging_arm, upright.
Rod upright_wires(double mass) {
  Rod rod;
  for (const double length : {0.35, 0.35, 0.3}) {
    RodSection section{
        .length = length, .radius = {2e-3, 2e-3}, .youngs_modulus = 54e9, .shear_modulus = 54e9 / 2.66};
    section.mass_per_length = mass;
    rod.sections.push_back(section);
  }
  for (int i = 0; i < 9; ++i)
    rod.tendons.push_back({.section = static_cast<std::size_t>(i / 3),
                           .radius = 0.015,
                           .angle = (120 * (i % 3) + 40 * (i / 3)) * std::numbers::pi / 180});
  return rod;
}

// It bears 0.54 kg/m alone, and more with tendons.
TEST(StaticsDescent, AHeavyArmThatCannotStandFallsOver) {
  const Rod rod = upright_wires(20);
  const RodLoads weight{.gravity = {0, 0, -9.81}};
  RodStatics statics(rod);
  Equilibrium at;
  for (const double degrees : {3, 8, 9, 10, 30}) {
    ArmState command = ArmState::straight(3);
    for (Eigen::Vector2d& bend : command.bends) bend.x() = degrees * std::numbers::pi / 180;
    const TendonInput input{.displacements = arc_displacements(rod, command).pulled};
    const Equilibrium cold = statics.solve(input, weight);
    EXPECT_TRUE(cold.converged() && cold.stable) << degrees << ": " << words(cold.end);
    EXPECT_TRUE(cold.ambiguous);
    at = statics.settle(input, weight, at);
    EXPECT_TRUE(at.converged() && at.stable) << degrees;
  }
}

TEST(StaticsDescent, AColumnThatNothingHoldsFallsToASide) {
  RodStatics statics(elastica(8));
  const RodLoads pushed{.ends = {{.section = 0, .force = {0, 0, -3}}}};  // 1.2 times L. Euler's load.
  const Equilibrium upright = statics.solve({}, pushed), fallen = statics.settle({}, pushed);
  ASSERT_TRUE(upright.converged() && fallen.converged());
  EXPECT_FALSE(upright.stable);
  EXPECT_TRUE(fallen.stable);
  EXPECT_TRUE(fallen.snapped && fallen.ambiguous);
  // It bends to any side, as far as a rod that is pushed a little.
  Rod planar = elastica(8);
  planar.sections[0].modes.planar = true;
  const Equilibrium aside = RodStatics(planar).solve({}, {.ends = {{.section = 0, .force = {1e-3, 0, -3}}}});
  EXPECT_NEAR(fallen.tip.position.head<2>().norm(), std::abs(aside.tip.position.x()), 5e-3);
  EXPECT_NEAR(fallen.tip.position.z(), aside.tip.position.z(), 5e-3);
  // It stays there.
  const Equilibrium again = statics.settle({}, pushed, fallen);
  EXPECT_TRUE(again.converged() && again.stable);
  EXPECT_LE((again.tip.position - fallen.tip.position).norm(), 1e-6);
}

// Three tendons that are just taut prevent tilting of a column's ends: it bears more than alone, at zero
// tension.
TEST(StaticsDescent, TendonsThatAreJustTautHoldAColumn) {
  Rod rod = elastica(6);
  for (int k = 0; k < 3; ++k)
    rod.tendons.push_back({.section = 0, .radius = 0.05, .angle = 2 * std::numbers::pi * k / 3});
  RodStatics statics(rod);
  const TendonInput taut{.displacements = {0, 0, 0}};
  const Equilibrium held = statics.settle(taut, {.ends = {{.section = 0, .force = {0, 0, -5}}}});
  ASSERT_TRUE(held.converged());
  EXPECT_TRUE(held.stable);
  EXPECT_LE(held.tip.position.head<2>().norm(), 1e-6);
  // At four times the load its ends slide against each other.
  const Equilibrium over = statics.settle(taut, {.ends = {{.section = 0, .force = {0, 0, -14}}}});
  ASSERT_TRUE(over.converged());
  EXPECT_TRUE(over.stable && over.snapped);
  EXPECT_GE(over.tip.position.head<2>().norm(), 0.05);
}

// Without an energy it comes to rest or reports that it did not.
TEST(StaticsDescent, FrictionAndFollowingLoadsAreFollowedToRest) {
  int found = 0, asked = 0;
  for_random_cases(12, [&](TestRandom& random) {
    UprightArm arm = upright_arm(random);
    const bool rubs = random.integer(0, 1) == 0;
    for (TendonRoute& tendon : arm.rod.tendons) tendon.friction = rubs ? 0.1 : 0;
    if (!rubs)
      arm.loads.ends.push_back(
          {.section = arm.rod.sections.size() - 1,
           .force = {0, 0, -random.uniform(0, 1) * arm.stiffness / std::pow(arm.rod.length(), 2)},
           .following = true});
    const ArmState command = upright_command(random, arm);
    RodStatics statics(arm.rod);
    const Equilibrium at =
        statics.settle({.displacements = arc_displacements(arm.rod, command).pulled}, arm.loads);
    ++asked;
    if (!at.converged()) {
      EXPECT_TRUE(at.end == StaticsEnd::out_of_steps || at.end == StaticsEnd::no_equilibrium);
      return;
    }
    ++found;
    EXPECT_TRUE(at.q.allFinite());
    RodChain chain(arm.rod);
    chain.balance(at.q, at.tensions, arm.loads, 1);
    EXPECT_LE(chain.residual().cwiseQuotient(chain.scales()).cwiseAbs().maxCoeff(),
              1e-6 * arm.stiffness / arm.rod.sections[0].length);
  });
  EXPECT_GE(found, asked - 3);
}

// Two tendons let a heavy arm lean; pulled past the top it snaps from its present shape.
TEST(StaticsDescent, SettlesWhereItFallsToFromWhereItIs) {
  Rod rod = elastica(8);
  rod.sections[0].modes.planar = true;
  rod.sections[0].rest_curvature = {{0, 1.5, 0}};
  rod.tendons = {{.section = 0, .radius = 0.05, .angle = std::numbers::pi}};
  RodStatics statics(rod);
  const RodLoads weight{.gravity = {0, 0, -10}};
  const Equilibrium leaning = statics.settle({.tensions = {1.1 * 1.5 / 0.05}}, weight);
  ASSERT_TRUE(leaning.converged() && leaning.stable);
  EXPECT_GT(leaning.tip.position.x(), 0.5);
  const Equilibrium over = statics.settle({.tensions = {1.2 * 1.5 / 0.05}}, weight, leaning);
  const Equilibrium way = statics.solve({.tensions = {1.2 * 1.5 / 0.05}}, weight);
  ASSERT_TRUE(over.converged() && over.stable && over.ambiguous);
  EXPECT_LE((over.tip.position - way.tip.position).norm(), 1e-8);
  // It stays there when the tension is reduced again: there are two equilibria.
  const Equilibrium back = statics.settle({.tensions = {1.1 * 1.5 / 0.05}}, weight, over);
  ASSERT_TRUE(back.converged() && back.stable);
  EXPECT_LT(back.tip.position.x(), -0.5);
}

}  // namespace
}  // namespace flexura
