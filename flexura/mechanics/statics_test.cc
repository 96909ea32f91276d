#include "flexura/mechanics/statics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/shooting_rod.h"

namespace flexura {
namespace {

void expect_near(const Eigen::Vector3d& found, const Eigen::Vector3d& expected, double within) {
  EXPECT_LE((found - expected).norm(), within) << found.transpose();
}

TEST(Statics, ATwoSectionRobotUnderItsTendons) {
  RodStatics statics(two_section_robot());
  const Equilibrium at = statics.solve({.tensions = {4, 0, 0, 0, 2, 0}}, {});
  ASSERT_TRUE(at.converged());
  EXPECT_TRUE(at.stable);
  EXPECT_FALSE(at.snapped || at.ambiguous);
  expect_near(at.tip.position, {0.127607603, 0.143467423, 0.336406799}, 2e-8);
}

TEST(Statics, ATwoSectionRobotUnderAForceAtItsTip) {
  RodStatics statics(two_section_robot());
  const Equilibrium at = statics.solve({}, {.ends = {{.section = 1, .force = {0.1, 0, 0}}}});
  ASSERT_TRUE(at.converged());
  expect_near(at.tip.position, {0.169688740, 0, 0.353786806}, 2e-8);
}

TEST(Statics, ATwoSectionRobotUnderOneTendon) {
  RodStatics statics(two_section_robot());
  const Equilibrium at = statics.solve({.tensions = {3, 0, 0, 0, 0, 0}}, {});
  ASSERT_TRUE(at.converged());
  expect_near(at.tip.position, {0, 0.168376662, 0.354895045}, 2e-8);
}

TEST(Statics, AHeavyRodUnderATendon) {
  const RodLoads weight{.gravity = {9.81, 0, 0}};
  Rod rod = heavy_rod();
  rod.sections[0].modes = {.shear = 3, .stretch = 3, .bend = 8, .twist = 1};
  RodStatics statics(rod);
  const Equilibrium at = statics.solve({.tensions = {15}}, weight);
  ASSERT_TRUE(at.converged());
  expect_near(at.tip.position, {0.182211695, 0, 0.453229271}, 1e-8);
  EXPECT_NEAR(at.tendon_lengths[0], 0.48870866, 1e-8);

  rod.sections[0].modes.shear = rod.sections[0].modes.stretch = 0;
  RodStatics inextensible(rod);
  const Equilibrium same = inextensible.solve({.tensions = {15}}, weight);
  ASSERT_TRUE(same.converged());
  expect_near(same.tip.position, {0.182216165, 0, 0.453239991}, 1e-8);
}

TEST(Statics, ACantileverWithAForceAtItsEnd) {
  struct Case {
    double force, aside, back;
  };
  for (const Case& known : {Case{1, 0.30172077, 0.05643324}, Case{2, 0.49345748, 0.16064172},
                            Case{5, 0.71379152, 0.38762836}, Case{10, 0.81060902, 0.55499560}}) {
    RodStatics statics(elastica(14));
    const Equilibrium at = statics.solve({}, {.ends = {{.section = 0, .force = {known.force, 0, 0}}}});
    ASSERT_TRUE(at.converged());
    expect_near(at.tip.position, {known.aside, 0, 1 - known.back}, 1.5e-8);
  }
}

TEST(Statics, ACantileverUnderItsWeight) {
  struct Case {
    double weight, drop;
  };
  for (const Case& known : {Case{1, 0.12347}, Case{10, 0.70020}, Case{50, 0.90792}}) {
    RodStatics statics(elastica(12));
    const Equilibrium at = statics.solve({}, {.gravity = {known.weight, 0, 0}});
    ASSERT_TRUE(at.converged());
    EXPECT_NEAR(at.tip.position.x(), known.drop, 1e-5);
    // Equal to a force along the rod.
    const Equilibrium spread = statics.solve({}, {.per_length = {known.weight, 0, 0}});
    expect_near(spread.tip.position, at.tip.position, 1e-12);
  }
}

TEST(Statics, AMomentRollsARodToACircle) {
  for (const bool following : {false, true}) {
    RodStatics statics(elastica(1));
    const Equilibrium at = statics.solve(
        {}, {.ends = {{.section = 0, .moment = {0, 2 * std::numbers::pi, 0}, .following = following}}});
    ASSERT_TRUE(at.converged());
    EXPECT_LE(at.tip.position.norm(), 1e-12);
    EXPECT_NEAR(at.strain_energy, 2 * std::numbers::pi * std::numbers::pi, 1e-10);
  }
}

// Euler: a clamped column with a free end buckles at pi^2 EI / 4 L^2.
TEST(Statics, AColumnIsStableUpToItsBucklingLoad) {
  const double critical = std::numbers::pi * std::numbers::pi / 4;
  RodStatics statics(elastica(8));
  const auto under = [&](double force) {
    return statics.solve({}, {.ends = {{.section = 0, .force = {0, 0, -force}}}});
  };
  const Equilibrium below = under(0.999 * critical), above = under(1.001 * critical);
  ASSERT_TRUE(below.converged() && above.converged());
  EXPECT_TRUE(below.stable);
  EXPECT_FALSE(below.ambiguous);
  EXPECT_FALSE(above.stable);
  EXPECT_TRUE(above.ambiguous);
  expect_near(above.tip.position, {0, 0, 1}, 1e-9);
}

// With a tiny imperfection it buckles to that side: the load path bends off before the branch point.
TEST(Statics, AColumnFallsTheWayItIsPushed) {
  const double critical = std::numbers::pi * std::numbers::pi / 4;
  for (const double over : {1.02, 1.5, 3.0}) {
    for (const double side : {0.003, -0.001}) {
      Rod column = elastica(10);
      column.sections[0].modes.planar = true;
      RodStatics statics(column);
      const Equilibrium at =
          statics.solve({}, {.ends = {{.section = 0, .force = {side * critical, 0, -over * critical}}}});
      ASSERT_TRUE(at.converged());
      EXPECT_TRUE(at.stable);
      EXPECT_GT(at.tip.position.x() * side, 0) << over;
    }
  }
}

// M. Beck's column under a follower load has no static divergence, however it is divided into sections.
TEST(Statics, StabilityUnderFollowingLoadsDoesNotDependOnSections) {
  for (const std::size_t cut : {1u, 2u, 4u}) {
    Rod column = elastica(6);
    column.sections[0].length = 1.0 / static_cast<double>(cut);
    column.sections.assign(cut, column.sections[0]);
    RodStatics statics(column);
    const Equilibrium at =
        statics.solve({}, {.ends = {{.section = cut - 1, .force = {0, 0, -12}, .following = true}}});
    ASSERT_TRUE(at.converged());
    EXPECT_TRUE(at.stable);
    EXPECT_FALSE(at.ambiguous);
  }
}

TEST(Statics, ARodIsNotTurnedInsideOut) {
  RodSection soft{.length = 0.5, .stiffness = Vector6d((Vector6d() << 1, 1, 1, 1e3, 1e3, 1e3).finished())};
  const Equilibrium at =
      RodStatics({.sections = {soft}, .tendons = {}}).solve({}, {.ends = {{.force = {0, 0, -2}}}});
  EXPECT_FALSE(at.converged());
}

// A column that is curved to one side and heavier than its buckling load falls to that side. A tendon on the
// other side holds it up, until it snaps over.
TEST(Statics, AColumnThatIsPulledOverSnaps) {
  Rod rod = elastica(8);
  rod.sections[0].modes.planar = true;
  rod.sections[0].rest_curvature = {{0, 1.5, 0}};
  rod.tendons = {{.section = 0, .radius = 0.05, .angle = std::numbers::pi}};
  RodStatics statics(rod);
  const RodLoads weight{.gravity = {0, 0, -10}};
  const Equilibrium leaning = statics.solve({.tensions = {1.1 * 1.5 / 0.05}}, weight);
  ASSERT_TRUE(leaning.converged());
  EXPECT_TRUE(leaning.stable);
  EXPECT_FALSE(leaning.snapped || leaning.ambiguous);
  EXPECT_GT(leaning.tip.position.x(), 0.5);
  const Equilibrium over = statics.solve({.tensions = {1.2 * 1.5 / 0.05}}, weight);
  ASSERT_TRUE(over.converged());
  EXPECT_TRUE(over.stable);
  EXPECT_TRUE(over.snapped && over.ambiguous);
  EXPECT_LT(over.tip.position.x(), -0.5);
}

TEST(Statics, RefusesWhatIsNoInput) {
  RodStatics statics(two_section_robot());
  const double nan = std::nan("");
  const auto problem = [&](const TendonInput& tendons, const RodLoads& loads) {
    const Equilibrium at = statics.solve(tendons, loads);
    EXPECT_EQ(at.end, StaticsEnd::bad_input);
    return at.problem;
  };
  EXPECT_EQ(problem({.tensions = {1, 0, 0, 0, 0, -1}}, {}), "a tension is below 0, but tendons cannot push");
  EXPECT_EQ(problem({.tensions = {1, 0, 0, 0, 0, nan}}, {}), "tensions must be finite");
  EXPECT_EQ(problem({.displacements = {1}}, {}), "1 displacements given: expected 6, one per tendon");
  EXPECT_EQ(problem({.tensions = {0, 0, 0, 0, 0, 0}, .displacements = {0, 0, 0, 0, 0, 0}}, {}),
            "both tensions and displacements are given: expected only one of them");
  EXPECT_EQ(problem({}, {.gravity = {0, nan, 0}}), "gravity and loads must be finite");
  EXPECT_EQ(problem({}, {.ends = {{.section = 0, .force = {nan, 0, 0}}}}), "loads must be finite");
  EXPECT_EQ(problem({}, {.ends = {{.section = 2}}}), "a load acts on a section that the rod does not have");
  Rod rod = two_section_robot();
  rod.sections[1].youngs_modulus = 0;
  rod.tendons[0].section = 2;
  try {
    RodStatics refused(rod);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(
        error.what(),
        "section 2: Young's modulus and shear modulus must be above 0; tendon 1: ends at a section that "
        "the rod does not have");
  }
}

// A section driven longer equals a longer section of the same material: each strain per metre is lower by the
// factor, so the stiffness is higher by it and the mass per metre lower.
TEST(Statics, ASectionThatIsDrivenLongerIsALongerOne) {
  for_random_cases(10, [](TestRandom& random) {
    Rod rod = two_section_robot();
    Rod longer = rod;
    const std::vector<double> factors = {random.uniform(0.7, 1.5), random.uniform(0.7, 1.5)};
    double base = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      RodSection &one = rod.sections[i], &other = longer.sections[i];
      one.mass_per_length = 0.3;
      other.length *= factors[i];
      other.stiffness = factors[i] * one.stiffness_at(0);
      other.mass_per_length = 0.3 / factors[i];
      base += one.length;
    }
    const RodLoads loads{.gravity = {9.81 * random.uniform(-1, 1), 0, -9.81},
                         .ends = {{.section = 1, .force = random.vector<3>(-0.1, 0.1)}}};
    const TendonInput pulls{.tensions = {random.uniform(0, 3), 0, 0, 0, random.uniform(0, 3), 0}};
    RodStatics driven(rod);
    driven.stretch_rest(factors);
    const Equilibrium a = driven.solve(pulls, loads), b = RodStatics(longer).solve(pulls, loads);
    ASSERT_TRUE(a.converged());
    ASSERT_TRUE(b.converged());
    EXPECT_LE((a.tip.position - b.tip.position).norm(), 1e-9 * base);
    EXPECT_NEAR(a.strain_energy, b.strain_energy, 1e-9 * b.strain_energy);
    // Back to the original length.
    driven.stretch_rest(std::vector<double>{1, 1});
    const Equilibrium before = driven.solve(pulls, loads), fresh = RodStatics(rod).solve(pulls, loads);
    EXPECT_LE((before.tip.position - fresh.tip.position).norm(), 1e-12 * base);
    EXPECT_THROW(driven.stretch_rest(std::vector<double>{1}), std::invalid_argument);
    EXPECT_THROW(driven.stretch_rest(std::vector<double>{1, 0}), std::invalid_argument);
  });
}

}  // namespace
}  // namespace flexura
