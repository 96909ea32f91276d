#include "flexura/mechanics/arm_rod.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "flexura/mechanics/statics.h"
#include "flexura/model/backbone.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// The arm of two_section_robot() as a file describes it, without its tendons.
ArmConfig wire_arm() {
  ArmConfig arm;
  arm.kind = ArmKind::spatial;
  arm.section.resize(2);
  for (Section& section : arm.section) {
    section.length = 0.2;
    section.radius = {0.012, 0.012};
    section.material = MaterialConfig{.youngs_modulus = 54e9, .radius = std::array{0.7e-3, 0.7e-3}};
  }
  return arm;
}

ArmConfig wire_arm_with_tendons() {
  ArmConfig arm = wire_arm();
  for (const int section : {1, 2})
    for (const double angle : {90.0, -30.0, 210.0})
      arm.tendon.push_back({.section = section, .radius = 0.01, .angle = angle * std::numbers::pi / 180});
  return arm;
}

DriveConfig wire_drive() {
  DriveConfig drive;
  drive.radius = 0.01;
  for (const int section : {1, 2})
    for (const double angle : {90.0, -30.0, 210.0}) {
      TendonConfig& tendon = drive.tendon.emplace_back();
      tendon.section = section;
      tendon.angle = angle * std::numbers::pi / 180;
    }
  return drive;
}

Pose tip_of(const Rod& rod, const std::vector<double>& tensions, const RodLoads& loads = {}) {
  RodStatics statics(rod);
  const Equilibrium at = statics.solve({.tensions = tensions}, loads);
  EXPECT_TRUE(at.converged()) << at.problem;
  return at.tip;
}

const std::vector<double> pulls = {4, 0, 0, 0, 2, 0};
const Eigen::Vector3d pulled_tip = {0.127607603, 0.143467423, 0.336406799};

TEST(ArmRod, IsTheKnownRobotOfItsTable) {
  EXPECT_LE((tip_of(rod_of(wire_arm_with_tendons()), pulls).position - pulled_tip).norm(), 2e-8);
}

TEST(ArmRod, TakesTheDrivesTendonsWhereTheArmHasNone) {
  EXPECT_LE((tip_of(rod_of(wire_arm(), wire_drive()), pulls).position - pulled_tip).norm(), 2e-8);
  EXPECT_TRUE(rod_of(wire_arm()).tendons.empty());
  DriveConfig other = wire_drive();
  other.tendon.pop_back();
  EXPECT_EQ(rod_of(wire_arm_with_tendons(), other).tendons.size(), 6U);
}

TEST(ArmRod, TakesTheDrivesDisksWithItsTendonsButForSectionsThatNameTheirOwn) {
  DriveConfig drive = wire_drive();
  drive.disks = 5;
  ArmConfig arm = wire_arm();
  arm.section[1].material->disks = 3;
  const Rod rod = rod_of(arm, drive);
  EXPECT_EQ(rod.sections[0].disks, 5);
  EXPECT_EQ(rod.sections[1].disks, 3);
  arm.tendon = wire_arm_with_tendons().tendon;
  EXPECT_EQ(rod_of(arm, drive).sections[0].disks, 0);
}

TEST(ArmRod, HasTheRestBendWhenNothingPulls) {
  ArmConfig arm = wire_arm();
  ArmState state = ArmState::straight(2);
  state.bends = {{0.7, 0.4}, {-0.3, 0.9}};
  for (std::size_t i = 0; i < 2; ++i)
    arm.section[i].material->rest_bend = {state.bends[i].x(), state.bends[i].y()};
  Arm standing = arm.arm();
  standing.X_WB = Pose{};
  const Pose expected = Backbone(standing, state).tip();
  const Pose found = tip_of(rod_of(arm), {});
  EXPECT_LE((found.position - expected.position).norm(), 1e-12);
  EXPECT_LE((found.rotation - expected.rotation).norm(), 1e-12);
}

TEST(ArmRod, HasTheRestTwistWhenNothingPulls) {
  ArmConfig arm = wire_arm();
  arm.section[0].material->rest_twist = 0.5;
  const Pose found = tip_of(rod_of(arm), {});
  EXPECT_NEAR(found.rotation(0, 0), std::cos(0.5), 1e-12);
  EXPECT_NEAR(found.rotation(1, 0), std::sin(0.5), 1e-12);  // x towards y
}

TEST(ArmRod, IsAsStiffTowardsXAsItsTableSays) {
  ArmConfig arm = wire_arm();
  arm.section.resize(1);
  arm.section[0].material = MaterialConfig{
      .stiffness = StiffnessConfig{.shear = {1e9, 1e9}, .stretch = 1e9, .bend = {0.1, 0.4}, .twist = 1}};
  const double force = 1e-3, third = 0.2 * 0.2 * 0.2 / 3;
  const RodLoads both{.ends = {{.section = 0, .force = {force, force, 0}}}};
  const Pose tip = tip_of(rod_of(arm), {}, both);
  EXPECT_NEAR(tip.position.x(), force * third / 0.1, 1e-4 * force * third / 0.1);
  EXPECT_NEAR(tip.position.y(), force * third / 0.4, 1e-4 * force * third / 0.4);
}

TEST(ArmRod, CarriesWhatItsTableSays) {
  ArmConfig arm = wire_arm();
  arm.section.resize(1);
  MaterialConfig& material = *arm.section[0].material;
  material.radius.reset();
  material.inner_radius = {0.001, 0.002};
  material.shear_modulus = 7e9;
  material.density = 1000;
  material.modes = {.shear = 1, .stretch = 3, .bend = 6, .twist = 2};
  material.nodes = 9;
  material.mass = {{.at = 0.5, .mass = 0.1, .offset = {0, 0.01, 0}}};
  const RodSection section = rod_of(arm).sections[0];
  EXPECT_EQ(section.radius, (std::array{0.012, 0.012}));
  EXPECT_EQ(section.inner_radius, (std::array{0.001, 0.002}));
  EXPECT_EQ(section.shear_modulus, 7e9);
  EXPECT_EQ(section.density, 1000);
  EXPECT_EQ(section.modes.counts(), (std::array{1, 1, 3, 6, 6, 2}));
  EXPECT_EQ(section.nodes, 9);
  ASSERT_EQ(section.masses.size(), 1U);
  EXPECT_EQ(section.masses[0].offset.y(), 0.01);
  EXPECT_TRUE(rod_problems(rod_of(arm)).empty());
  material.shear_modulus.reset();
  material.poisson = 0.5;
  EXPECT_DOUBLE_EQ(rod_of(arm).sections[0].shear_modulus, 54e9 / 3);
}

TEST(ArmRod, RunsItsTendonsWhereTheModelSays) {
  for_random_cases(50, [](TestRandom& random) {
    ArmConfig arm = wire_arm();
    const TendonRouteConfig tendon{.section = 2,
                                   .radius = random.uniform(0, 0.01),
                                   .angle = random.uniform(-3, 3),
                                   .end_radius = random.uniform(0, 0.01),
                                   .turns = random.uniform(-2, 2),
                                   .x = {random.uniform(-1e-3, 1e-3), random.uniform(-1e-2, 1e-2)},
                                   .y = {0, 0, random.uniform(-1e-2, 1e-2)}};
    arm.tendon = {tendon};
    const TendonRoute route = rod_of(arm).tendons[0];
    for (const double s : {0.0, 0.1, 0.2, 0.37, 0.4})
      EXPECT_LE((route.at(s).value.head<2>() - tendon.offset(s, 0.4)).norm(), 1e-15) << s;
  });
}

TEST(ArmRod, TurnsWhatPullsIntoTheFrameOfTheBase) {
  ArmConfig arm = wire_arm();  // Its z is the world's Y, its x the world's X.
  arm.gravity = {0, -9.81, 0};
  arm.load = {{.section = 2, .force = {1, 2, 3}, .moment = {4, 5, 6}},
              {.section = 1, .force = {1, 2, 3}, .following = true}};
  const RodLoads loads = loads_of(arm);
  EXPECT_LE((loads.gravity - Eigen::Vector3d(0, 0, -9.81)).norm(), 1e-15);
  ASSERT_EQ(loads.ends.size(), 2U);
  EXPECT_EQ(loads.ends[0].section, 1U);
  EXPECT_LE((loads.ends[0].force - Eigen::Vector3d(1, -3, 2)).norm(), 1e-15);
  EXPECT_LE((loads.ends[0].moment - Eigen::Vector3d(4, -6, 5)).norm(), 1e-15);
  EXPECT_FALSE(loads.ends[0].following);
  EXPECT_EQ(loads.ends[1].force, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(loads.ends[1].following);
}

// A tendon 60 mm beside a section of 0.2 m reaches the middle of its bend at 3.3 rad.
TEST(ArmRod, PullsTendonsInByMoreTheStrongerABendIs) {
  for (const int disks : {0, 10}) {
    for (const double end_radius : {0.06, 0.02}) {
      ArmConfig arm = wire_arm();
      arm.section.resize(1);
      arm.tendon = {{.section = 1, .radius = 0.06, .angle = 0.3, .end_radius = end_radius}};
      Rod rod = rod_of(arm);
      rod.sections[0].disks = disks;
      const auto state = [](double bend) {
        ArmState bent = ArmState::straight(1);
        bent.bends[0] = bend * Eigen::Vector2d(std::cos(0.3), std::sin(0.3));
        return bent;
      };
      const auto pulled = [&](double bend) { return arc_displacements(rod, state(bend)).pulled[0]; };
      for (double bend = 0.05; bend < 9; bend += 0.05) {
        EXPECT_GT(pulled(bend), pulled(bend - 0.05)) << bend << ", disks " << disks;
        const double along = arc_displacement_slopes(rod, state(bend))
                                 .row(0)
                                 .head<2>()
                                 .dot(Eigen::Vector2d(std::cos(0.3), std::sin(0.3)));
        EXPECT_NEAR(along, (pulled(bend + 1e-6) - pulled(bend - 1e-6)) / 2e-6, 1e-4) << bend;
      }
    }
  }
}

TEST(ArmRod, RefusesAnArmWithoutAMaterial) {
  ArmConfig arm = wire_arm();
  arm.section[1].material.reset();
  EXPECT_THROW((void)rod_of(arm), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
