#include "flexura/mechanics/statics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

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
  const RodLoads loads{.ends = {{.section = 1, .force = {0.1, 0, 0}}}};
  const Equilibrium at = statics.solve({}, loads);
  ASSERT_TRUE(at.converged());
  expect_near(at.tip.position, {0.169688740, 0, 0.353786806}, 2e-8);
  const Equilibrium both = statics.solve({.tensions = {3, 0, 0, 0, 0, 0}}, loads);
  ASSERT_TRUE(both.converged());
  expect_near(both.tip.position, {0, 0, 0}, 1);
  std::printf("D iterations %d, E? tip %.9f %.9f %.9f\n", at.iterations, both.tip.position.x(), both.tip.position.y(), both.tip.position.z());
}

TEST(Statics, OneTendon) {
  RodStatics statics(two_section_robot());
  const Equilibrium at = statics.solve({.tensions = {3, 0, 0, 0, 0, 0}}, {});
  ASSERT_TRUE(at.converged());
  expect_near(at.tip.position, {0, 0.168376662, 0.354895045}, 2e-8);
}

TEST(Statics, AHeavyRodUnderATendon) {
  const RodLoads weight{.gravity = {9.81, 0, 0}};
  Rod rod = heavy_rod();
  {
    RodStatics statics(rod);
    const Equilibrium at = statics.solve({.tensions = {15}}, weight);
    ASSERT_TRUE(at.converged());
    expect_near(at.tip.position, {0.182211695, 0, 0.453229271}, 2e-8);
    EXPECT_NEAR(at.tendon_lengths[0], 0.48870866, 2e-8);
  }
  rod.sections[0].modes.shear = rod.sections[0].modes.stretch = 0;
  RodStatics statics(rod);
  const Equilibrium at = statics.solve({.tensions = {15}}, weight);
  ASSERT_TRUE(at.converged());
  expect_near(at.tip.position, {0.182216165, 0, 0.453239991}, 2e-8);
}

TEST(Statics, ACantileverWithAForceAtItsEnd) {
  const double force[] = {1, 2, 5, 10};
  const double w[] = {.30172077, .49345748, .71379152, .81060902}, u[] = {.05643324, .16064172, .38762836, .55499560};
  for (int i = 0; i < 4; ++i) {
    RodStatics statics(elastica(10));
    const Equilibrium at = statics.solve({}, {.ends = {{.section = 0, .force = {force[i], 0, 0}}}});
    ASSERT_TRUE(at.converged());
    expect_near(at.tip.position, {w[i], 0, 1 - u[i]}, 2e-8);
  }
}

TEST(Statics, ACantileverUnderItsWeight) {
  const double weight[] = {1, 10, 50}, drop[] = {.12347, .70020, .90792};
  for (int i = 0; i < 3; ++i) {
    RodStatics statics(elastica(10));
    const Equilibrium at = statics.solve({}, {.gravity = {weight[i], 0, 0}});
    ASSERT_TRUE(at.converged());
    EXPECT_NEAR(at.tip.position.x(), drop[i], 1e-5);
  }
}

TEST(Statics, AMomentRollsARodToACircle) {
  RodStatics statics(elastica(4));
  const Equilibrium at = statics.solve({}, {.ends = {{.section = 0, .moment = {0, 2 * std::numbers::pi, 0}}}});
  ASSERT_TRUE(at.converged());
  EXPECT_LE(at.tip.position.norm(), 1e-9);
}

}  // namespace
}  // namespace flexura
