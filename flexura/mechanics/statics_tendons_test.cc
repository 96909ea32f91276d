#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "flexura/mechanics/statics.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"
#include "tests/support/shooting_rod.h"

namespace flexura {
namespace {

TEST(StaticsTendons, DisplacementsLeadBackToTheirTensions) {
  for_random_cases(40, [](TestRandom& random) {
    Rod rod = random_rod(random, 0.2);
    for (TendonRoute& tendon : rod.tendons) tendon.compliance = random.uniform(1e-5, 1e-3);
    const std::vector<double> tensions = random_tensions(random, rod, 6);
    const RodLoads loads = random_loads(random, rod);
    RodStatics statics(rod);
    const Equilibrium pulled = statics.solve({.tensions = tensions}, loads);
    ASSERT_TRUE(pulled.converged());
    // Tendons without tension follow the shape; let out further, they stay slack.
    std::vector<double> displacements = pulled.displacements;
    for (std::size_t i = 0; i < tensions.size(); ++i)
      if (tensions[i] == 0) displacements[i] -= 0.001;
    const Equilibrium held = statics.solve({.displacements = displacements}, loads);
    ASSERT_TRUE(held.converged()) << words(held.end);
    EXPECT_LE((held.tip.position - pulled.tip.position).norm(), 1e-8);
    for (std::size_t i = 0; i < tensions.size(); ++i) EXPECT_NEAR(held.tensions[i], tensions[i], 1e-6);
  });
}

TEST(StaticsTendons, ATendonThatIsLetOutHangsSlackAndDoesNotPush) {
  RodStatics statics(two_section_robot());
  const Equilibrium at = statics.solve({.displacements = {-0.01, -0.01, -0.01, 0.004, -0.01, -0.01}}, {});
  ASSERT_TRUE(at.converged());
  for (const std::size_t slack : {0u, 1u, 2u, 4u, 5u}) EXPECT_EQ(at.tensions[slack], 0);
  EXPECT_GT(at.tensions[3], 0.1);
  EXPECT_NEAR(at.tendon_lengths[3], 0.4 - 0.004, 1e-9);
  // A pretension: all six are pulled in against each other.
  const Equilibrium tight =
      statics.solve({.displacements = {2.5e-5, 2.5e-5, 2.5e-5, 3.5e-5, 3.5e-5, 3.5e-5}}, {});
  ASSERT_TRUE(tight.converged());
  for (const double tension : tight.tensions) EXPECT_GT(tension, 0.1);
  EXPECT_LE((tight.tip.position - Eigen::Vector3d(0, 0, 0.4)).head<2>().norm(), 1e-9);
}

// Four inextensible tendons on a section, two of them pulled in against each other: the others are slack.
TEST(StaticsTendons, ThatContradictEachOtherPullOrHangSlack) {
  Rod rod = two_section_robot();
  rod.sections.pop_back();
  rod.tendons.clear();
  for (int i = 0; i < 4; ++i)
    rod.tendons.push_back({.section = 0, .radius = 0.01, .angle = i * std::numbers::pi / 2});
  RodStatics statics(rod);
  const Equilibrium two = statics.solve({.displacements = {1e-3, 0, 1e-3, 0}}, {});
  ASSERT_TRUE(two.converged() && two.stable);
  EXPECT_FALSE(two.ambiguous);
  EXPECT_EQ(two.tensions[1], 0);
  EXPECT_EQ(two.tensions[3], 0);
  EXPECT_NEAR(two.tensions[0], two.tensions[2], 1e-6 * two.tensions[0]);
  EXPECT_NEAR(two.tendon_lengths[0], 0.2 - 1e-3, 1e-7);
  const Equilibrium all = statics.solve({.displacements = std::vector<double>(4, 1e-5)}, {});
  ASSERT_TRUE(all.converged() && all.stable);
  EXPECT_FALSE(all.ambiguous);
  for (const double tension : all.tensions) EXPECT_GT(tension, 0.5);
  // An inextensible rod takes no pretension by lengths, but bends by their differences.
  rod.sections[0].modes.stretch = 0;
  const Equilibrium stiff =
      RodStatics(rod).solve({.displacements = {2e-3, 0, -2e-3, 0}}, {.gravity = {3, 1, -9}});
  ASSERT_TRUE(stiff.converged());
  EXPECT_NEAR(stiff.tendon_lengths[0], 0.2 - 2e-3, 1e-6);
}

// A rod that bends evenly by an angle turns its tendon by that angle.
TEST(StaticsTendons, FrictionIsThatOfACapstan) {
  Rod rod = elastica(1);
  rod.tendons = {{.section = 0, .radius = 0.05, .friction = 0.3}};
  RodStatics statics(rod);
  const Equilibrium at = statics.solve({.tensions = {30}}, {});
  ASSERT_TRUE(at.converged());
  // EI bend = mean of T d exp(-mu s bend) over the length.
  const double bend = at.q[statics.chain().elements()[0].grid().first[4]];
  EXPECT_NEAR(bend, 30 * 0.05 * (1 - std::exp(-0.3 * bend)) / (0.3 * bend), 1e-8);
}

TEST(StaticsTendons, FrictionWithoutModesToHoldItBackIsThatOfTheEquations) {
  // With enough modes, each place has the curvature of the remaining tension there: EI u = T d exp(-mu
  // angle), so exp(mu angle) is linear along the rod.
  Rod rod = elastica(10);
  const double mu = 0.4, d = 0.05, tension = 30;
  rod.tendons = {{.section = 0, .radius = d, .friction = mu}};
  RodStatics statics(rod);
  const Equilibrium at = statics.solve({.tensions = {tension}}, {});
  ASSERT_TRUE(at.converged());
  const double angle = std::log1p(mu * tension * d) / mu;
  const Eigen::Vector3d z = at.tip.rotation.col(2);
  EXPECT_NEAR(std::atan2(z.x(), z.z()), angle, 1e-9);
}

// docs/drives.md: for a bend u, all lengths between n disks shrink by sinc(|u| / 2n).
TEST(StaticsTendons, RunStraightBetweenDisks) {
  for_random_cases(20, [](TestRandom& random) {
    Rod rod = elastica(1);
    const int disks = random.integer(1, 12);
    rod.sections[0].disks = disks;
    rod.tendons = {{.section = 0, .radius = 0.05, .angle = random.uniform(-3, 3)},
                   {.section = 0, .radius = 0.04, .angle = random.uniform(-3, 3)}};
    RodStatics statics(rod);
    const Equilibrium at = statics.solve({.tensions = {random.uniform(1, 40), random.uniform(1, 40)}}, {});
    ASSERT_TRUE(at.converged());
    const RodGrid& grid = statics.chain().elements()[0].grid();
    const Eigen::Vector2d bend(at.q[grid.first[4]], -at.q[grid.first[3]]);
    const double half = bend.norm() / (2 * disks);
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Vector2d offset = rod.tendons[i].at(0).value.head<2>();
      EXPECT_NEAR(at.tendon_lengths[i], (1 - offset.dot(bend)) * std::sin(half) / half, 1e-10);
    }
  });
}

TEST(StaticsTendons, BetweenManyDisksAreThoseOfAChannel) {
  for_random_cases(6, [](TestRandom& random) {
    Rod rod = random_rod(random);
    const std::vector<double> tensions = random_tensions(random, rod, 5);
    const RodLoads loads = random_loads(random, rod);
    const Equilibrium channel = RodStatics(rod).solve({.tensions = tensions}, loads);
    const auto with_disks = [&](int disks) {
      for (RodSection& section : rod.sections) section.disks = disks;
      const Equilibrium at = RodStatics(rod).solve({.tensions = tensions}, loads);
      EXPECT_TRUE(at.converged());
      return (at.tip.position - channel.tip.position).norm();
    };
    const double few = with_disks(10), many = with_disks(40);
    // Second order in the pieces' length.
    if (few > 1e-7) {
      EXPECT_NEAR(std::log2(few / many), 4, 1.2);
    }
    EXPECT_LE(many, 1e-3);
  });
}

// The kink force where a tendon passes the end of a section: one section equals two.
TEST(StaticsTendons, PassTheEndsOfSectionsAsIfThereWereNone) {
  for_random_cases(20, [](TestRandom& random) {
    Rod rod = random_rod(random);
    rod.sections.resize(1);
    rod.sections[0].rest_curvature.clear();
    rod.sections[0].masses.clear();
    rod.sections[0].radius = {1e-3, 1e-3};
    rod.sections[0].modes = {.shear = 3, .stretch = 3, .bend = 9, .twist = 8};
    for (TendonRoute& tendon : rod.tendons) tendon.section = 0;
    const std::vector<double> tensions = random_tensions(random, rod, 5);
    RodLoads loads{.gravity = random.vector<3>(-10.0, 10.0),
                   .ends = {{.force = random.vector<3>(-0.1, 0.1)}}};
    const Equilibrium whole = RodStatics(rod).solve({.tensions = tensions}, loads);
    rod.sections[0].length *= 0.5;
    rod.sections.push_back(rod.sections[0]);
    for (TendonRoute& tendon : rod.tendons) tendon.section = 1;
    loads.ends[0].section = 1;
    const Equilibrium halves = RodStatics(rod).solve({.tensions = tensions}, loads);
    ASSERT_TRUE(whole.converged() && halves.converged());
    EXPECT_LE((whole.tip.position - halves.tip.position).norm(), 1e-5);
  });
}

}  // namespace
}  // namespace flexura
