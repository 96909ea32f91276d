#include "flexura/sim/tendon_pull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "flexura/mechanics/arm_rod.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double radius = 0.01;

// Two sections with three tendons to the end of each, in a channel or between disks.
RigConfig config_of(ArmKind kind = ArmKind::spatial, int disks = 0) {
  RigConfig config;
  config.arm.kind = kind;
  config.arm.mechanics = ArmMechanics::statics;
  for (int i = 0; i < 2; ++i) {
    Section& section = config.arm.section.emplace_back();
    section.length = 0.2;
    MaterialConfig& material = section.material.emplace();
    material.youngs_modulus = 54e9, material.radius = {7e-4, 7e-4};
    if (disks > 0) material.disks = disks;
  }
  for (int i = 0; i < 6; ++i)
    config.arm.tendon.push_back(
        {.section = 1 + i / 3, .radius = radius, .angle = 2 * std::numbers::pi * i / 3});
  return config;
}

TEST(NearestArcs, AreThoseThatMadeTheDisplacements) {
  for (const int disks : {0, 6}) {
    const ArmSetup setup(config_of(ArmKind::spatial, disks));
    for_random_cases(50, [&](TestRandom& random) {
      ArmState state = ArmState::straight(2);
      for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-2, 2);
      const auto pulled = arc_displacements(setup.rod->rod, state).pulled;
      const ArmState found = nearest_arcs(setup.rod->rod, setup.arm, pulled);
      for (std::size_t i = 0; i < 2; ++i) EXPECT_LT((found.bends[i] - state.bends[i]).norm(), 1e-8);
    });
  }
}

// One tendon pulled alone: a third of its displacement is common to all three tendons, which no bend
// produces.
TEST(NearestArcs, OfDisplacementsThatNoArcsMakeAreTheNearest) {
  const ArmSetup setup(config_of());
  const ArmState found = nearest_arcs(setup.rod->rod, setup.arm, {0.003, 0, 0, 0, 0, 0});
  const auto miss = [&](const ArmState& state) {
    const auto pulled = arc_displacements(setup.rod->rod, state).pulled;
    double sum = std::pow(pulled[0] - 0.003, 2);
    for (std::size_t i = 1; i < 6; ++i) sum += pulled[i] * pulled[i];
    return sum;
  };
  for (const double step : {-1e-3, 1e-3})
    for (std::size_t i = 0; i < 4; ++i) {
      ArmState other = found;
      other.bends[i / 2][static_cast<Eigen::Index>(i % 2)] += step;
      EXPECT_GT(miss(other), miss(found));
    }
}

TEST(NearestArcs, StayStraightWhereTendonsDoNotSay) {
  RigConfig config = config_of();
  config.arm.tendon.resize(1);
  const ArmSetup setup(config);
  const ArmState found = nearest_arcs(setup.rod->rod, setup.arm, {0.005});
  EXPECT_NEAR(found.bends[0].x(), 0.5, 1e-6);
  EXPECT_NEAR(found.bends[0].y(), 0, 1e-6);
  EXPECT_LT(found.bends[1].norm(), 1e-9);
}

// A tendon that winds half around the arm hardly determines bends perpendicular to its mean direction.
TEST(NearestArcs, OfAHelicalTendonStayInItsPlane) {
  RigConfig config = config_of();
  config.arm.section.resize(1);
  config.arm.tendon = {{.section = 1, .radius = radius, .turns = 0.5}};
  const ArmSetup setup(config);
  for (const double pulled : {-0.01, 0.005, 0.03}) {
    const ArmState found = nearest_arcs(setup.rod->rod, setup.arm, {pulled});
    EXPECT_NEAR(found.bends[0].x(), 0, 1e-6);
    EXPECT_NEAR(arc_displacements(setup.rod->rod, found).pulled[0], pulled, 1e-9);
  }
}

TEST(NearestArcs, StretchWhatMayStretch) {
  RigConfig config = config_of();
  config.arm.section[1].stretch_limits = {0.9, 1.1};
  const ArmSetup setup(config);
  const ArmState state{{{0.3, -0.4}, {0.2, 0.7}}, {1, 1.02}};
  const ArmState found =
      nearest_arcs(setup.rod->rod, setup.arm, arc_displacements(setup.rod->rod, state).pulled);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT((found.bends[i] - state.bends[i]).norm(), 1e-8);
    EXPECT_NEAR(found.stretches[i], state.stretches[i], 1e-8);
  }
}

TEST(NearestArcs, RefuseWhatAreNoDisplacements) {
  const ArmSetup setup(config_of());
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)nearest_arcs(setup.rod->rod, setup.arm, {0, 0}), std::invalid_argument);
  EXPECT_THROW((void)nearest_arcs(setup.rod->rod, setup.arm, {0, 0, 0, 0, 0, none}), std::invalid_argument);
}

TEST(PulledTendons, GoAsFarAsBendsWithinTheLimitsDo) {
  RigConfig config = config_of();
  config.arm.section[0].max_bend = 2;
  const auto tendons = pulled_tendons(ArmSetup(config));
  ASSERT_EQ(tendons.size(), 6U);
  EXPECT_NEAR(tendons[0].range[1], radius * 2, 1e-12);
  EXPECT_NEAR(tendons[0].range[0], -radius * 2, 1e-12);
  EXPECT_NEAR(tendons[3].range[1], radius * (2 + 2 * std::numbers::pi), 1e-12);
  EXPECT_EQ(tendons[3].section, 1U);
}

TEST(PulledTendons, GoNoFartherThanTheirMotors) {
  RigConfig config = config_of();
  DriveConfig& drive = config.drive.emplace();
  for (int i = 0; i < 6; ++i) {
    TendonConfig& tendon = drive.tendon.emplace_back();
    tendon.section = 1 + i / 3, tendon.radius = radius, tendon.angle = 2 * std::numbers::pi * i / 3;
  }
  drive.motor.max_position = 1000;
  const double most = 1000 / drive.drive().axes[0].microsteps_a_metre();
  ASSERT_LT(most, 2 * std::numbers::pi * radius);
  for (const PulledTendon& tendon : pulled_tendons(ArmSetup(config))) {
    EXPECT_NEAR(tendon.range[0], -most, 1e-12);
    EXPECT_NEAR(tendon.range[1], most, 1e-12);
  }
}

// With three tendons around a section, the others move half as far in the opposite direction. Those that run
// through to the next section move along.
TEST(PulledTendons, GoTogetherSoThatNonePullsAgainstAnother) {
  const ArmSetup setup(config_of());
  const auto tendons = pulled_tendons(setup);
  const std::vector<double> first = {1, -0.5, -0.5, 1, -0.5, -0.5}, fourth = {0, 0, 0, 1, -0.5, -0.5};
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(tendons[0].together[i], first[i], 1e-6) << i;
    EXPECT_NEAR(tendons[3].together[i], fourth[i], 1e-6) << i;
  }
  std::vector<double> pulled(6);
  for (std::size_t i = 0; i < 6; ++i)
    pulled[i] = 0.004 * tendons[0].together[i] + 0.002 * tendons[5].together[i];
  const auto arcs = arc_displacements(setup.rod->rod, nearest_arcs(setup.rod->rod, setup.arm, pulled)).pulled;
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(arcs[i], pulled[i], 1e-8) << i;
}

// A tendon offset perpendicular to the plane bends nothing, and is pulled alone.
TEST(PulledTendons, OfAPlaneGoAlongInIt) {
  RigConfig config = config_of(ArmKind::planar);
  config.arm.tendon = {{.section = 2, .radius = radius, .angle = 0},
                       {.section = 2, .radius = radius, .angle = std::numbers::pi},
                       {.section = 2, .radius = radius, .angle = std::numbers::pi / 2}};
  const auto tendons = pulled_tendons(ArmSetup(config));
  EXPECT_NEAR(tendons[0].together[1], -1, 1e-6);
  EXPECT_EQ(tendons[2].together, (std::vector<double>{0, 0, 1}));
}

TEST(PulledTendons, SayWhereTheyRun) {
  const auto tendons = pulled_tendons(ArmSetup(config_of()));
  const auto& [s, x, y] = tendons[1].route.back();
  EXPECT_NEAR(s, 0.2, 1e-12);
  EXPECT_NEAR(x, -radius / 2, 1e-12);
  EXPECT_NEAR(y, radius * std::sqrt(0.75), 1e-12);
  EXPECT_EQ(tendons[5].route.front()[0], 0);
  EXPECT_NEAR(tendons[5].route.back()[0], 0.4, 1e-12);
}

TEST(PulledTendons, AreNoneOfAnArmOfArcs) {
  RigConfig config = config_of();
  config.arm.mechanics = ArmMechanics::kinematic;
  EXPECT_TRUE(pulled_tendons(ArmSetup(config)).empty());
}

}  // namespace
}  // namespace flexura
