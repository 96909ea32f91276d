#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstdio>

#include "flexura/mechanics/statics.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"
#include "tests/support/shooting_rod.h"
#include "tests/support/upright_arms.h"

namespace flexura {
namespace {

// Wrench at the base of a rod in equilibrium: start of the shooting method.
Vector6d wrench_at_base(const Rod& rod, const Equilibrium& at, const std::vector<double>& tensions,
                        const RodLoads& loads) {
  RodChain chain(rod);
  chain.balance(at.q, tensions, loads, 1);
  Vector6d wrench = Vector6d::Zero();
  for (const RodElement& element : chain.elements()) wrench += element.wrench;
  return wrench;
}

Rod finer(Rod rod, int modes) {
  for (RodSection& section : rod.sections)
    section.modes = {.shear = modes - 2, .stretch = modes - 2, .bend = modes, .twist = modes};
  return rod;
}

TEST(StaticsReference, AThousandRobotsFromACold) {
  double worst = 0;
  for_random_cases(1000, [&](TestRandom& random) {
    const Rod rod = random_rod(random);
    const std::vector<double> tensions = random_tensions(random, rod, 8);
    const RodLoads loads = random_loads(random, rod);
    const Equilibrium at = RodStatics(rod).solve({.tensions = tensions}, loads);
    ASSERT_TRUE(at.converged()) << words(at.end);
    ShootingRod reference(rod, tensions, loads);
    const ShootingRod::Shot shot = reference.shoot(wrench_at_base(rod, at, tensions, loads));
    ASSERT_TRUE(shot.hit) << shot.miss;
    const double difference = (shot.tip.position - at.tip.position).norm() / rod.length();
    worst = std::max(worst, difference);
    EXPECT_LE(difference, 2e-3);
    if (difference < 1e-6) return;
    // The difference came from too few modes.
    const Equilibrium finely = RodStatics(finer(rod, 9)).solve({.tensions = tensions}, loads);
    ASSERT_TRUE(finely.converged());
    EXPECT_LE((shot.tip.position - finely.tip.position).norm(), 0.05 * difference + 1e-6);
    for (std::size_t i = 0; i < rod.tendons.size(); ++i)
      EXPECT_NEAR(shot.lengths[i], finely.tendon_lengths[i], 1e-6);
  });
  std::printf("the farthest from the witness: %.1e of the length\n", worst);
}

TEST(StaticsReference, EachModeMoreComesNearer) {
  for_random_cases(12, [](TestRandom& random) {
    Rod rod = random_rod(random);
    for (RodSection& section : rod.sections) section.masses.clear();  // The curvature has a kink there.
    const std::vector<double> tensions = random_tensions(random, rod, 6);
    RodLoads loads = random_loads(random, rod);
    loads.gravity = random.vector<3>(-10.0, 10.0);
    const Equilibrium first = RodStatics(rod).solve({.tensions = tensions}, loads);
    ShootingRod reference(rod, tensions, loads);
    const ShootingRod::Shot shot = reference.shoot(wrench_at_base(rod, first, tensions, loads));
    ASSERT_TRUE(shot.hit);
    const auto error = [&](int modes) {
      const Equilibrium at = RodStatics(finer(rod, modes)).solve({.tensions = tensions}, loads);
      EXPECT_TRUE(at.converged());
      return (at.tip.position - shot.tip.position).norm();
    };
    const double coarse = error(3), fine = error(6), finest = error(9);
    EXPECT_LE(fine, 0.2 * coarse + 1e-8);
    EXPECT_LE(finest, 0.2 * fine + 2e-8);
  });
}

TEST(StaticsDescentFull, HundredsOfSoftUprightArmsComeToAStableRest) {
  for_random_cases(400, [](TestRandom& random) { expect_upright_arm_rests(random); });
}

}  // namespace
}  // namespace flexura
