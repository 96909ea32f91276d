#include "flexura/mechanics/rod_modes.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "tests/support/known_rods.h"

namespace flexura {
namespace {

Rod steel_rod(double damping_time, bool planar = true) {
  Rod rod = heavy_rod();
  rod.sections[0].modes = {.shear = 0, .stretch = 0, .bend = 12, .twist = 0, .planar = planar};
  rod.sections[0].damping_time = damping_time;
  return rod;
}

RodModes modes_at_rest(const Rod& rod, const TendonInput& tendons = {}) {
  RodDynamics dynamics(rod);
  const Equilibrium at = RodStatics(rod).solve(tendons, {});
  EXPECT_TRUE(at.converged());
  return rod_modes(dynamics.slopes(dynamics.rest(at), tendons, {}));
}

TEST(RodModes, OfACantileverAreThoseOfEulerAndBernoulli) {
  const RodModes modes = modes_at_rest(steel_rod(0));
  const std::vector<double> known = {5.595912, 35.068983, 98.194166, 192.421376};
  ASSERT_GE(modes.frequencies.size(), known.size());
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_NEAR(modes.frequencies[i], known[i], 1e-4 * known[i]);
    EXPECT_NEAR(modes.damping_ratios[i], 0, 1e-9);
  }
}

// With viscosity D = T K the damping ratio is T w / 2; above 1 there are no oscillations.
TEST(RodModes, AreDampedInProportionToTheirFrequency) {
  const double time = 1e-3;
  const RodModes free = modes_at_rest(steel_rod(0)), damped = modes_at_rest(steel_rod(time));
  ASSERT_EQ(free.eigenvalues.size(), damped.eigenvalues.size());
  std::size_t swinging = 0;
  for (const double frequency : free.frequencies)
    if (time * std::numbers::pi * frequency < 1) ++swinging;
  ASSERT_EQ(damped.frequencies.size(), swinging);
  ASSERT_GE(swinging, 3U);
  for (std::size_t i = 0; i < swinging; ++i) {
    EXPECT_NEAR(damped.frequencies[i], free.frequencies[i], 1e-6 * free.frequencies[i]);
    EXPECT_NEAR(damped.damping_ratios[i], time * std::numbers::pi * free.frequencies[i], 1e-6);
  }
  for (Eigen::Index i = 1; i < damped.eigenvalues.size(); ++i)
    EXPECT_GE(std::abs(damped.eigenvalues[i]), (1 - 1e-12) * std::abs(damped.eigenvalues[i - 1]));
  EXPECT_LT(damped.eigenvalues.real().maxCoeff(), 0);
}

TEST(RodModes, AreTheEigenvaluesOfTheLinearModel) {
  Rod rod = two_section_robot();
  for (RodSection& section : rod.sections) {
    section.density = 6000;
    section.damping_time = 1e-3;
    section.modes = {.shear = 0, .stretch = 0, .bend = 2, .twist = 1};
  }
  const TendonInput tendons{.tensions = {2, 0.5, 0.1, 0.2, 1, 0.3}};
  const Equilibrium at = RodStatics(rod).solve(tendons, {});
  RodDynamics dynamics(rod);
  const RodState state = dynamics.rest(at);
  const RodModes modes = rod_modes(dynamics.slopes(state, tendons, {}));
  const Eigen::MatrixXd A = dynamics.linearize(state, tendons, {}).A_rest;
  for (const std::complex<double>& value : modes.eigenvalues) {
    const Eigen::VectorXcd all = A.eigenvalues();
    EXPECT_LT((all.array() - value).abs().minCoeff(), 1e-6 * std::abs(value));
  }
}

// An inextensible held tendon fixes the tip's direction in its plane (roots of tan x = -tanh x instead of cos
// x cosh x = -1). Its compliance is 1e-8 of the rod's, and slow modes are still exact.
TEST(RodModes, OfARodWhoseTendonIsHeldAreStifferInItsPlane) {
  Rod rod = steel_rod(0, false);
  rod.sections[0].modes.bend = 6;
  const RodModes free = modes_at_rest(rod), held = modes_at_rest(rod, {.displacements = {1e-3}});
  ASSERT_EQ(free.frequencies.size(), held.frequencies.size());
  EXPECT_NEAR(held.frequencies[0], free.frequencies[0], 0.01 * free.frequencies[0]);  // Transverse to it.
  const double ratio = std::pow(2.365020372 / 1.875104069, 2);
  EXPECT_NEAR(held.frequencies[1], ratio * free.frequencies[0], 2e-4 * held.frequencies[1]);
  EXPECT_GT(held.frequencies.back(), 100 * free.frequencies.back());
}

TEST(RodModes, OfAColumnThatFallsOneGrows) {
  Rod rod = steel_rod(0);
  RodDynamics dynamics(rod);
  const RodLoads weight{.ends = {{.section = 0, .force = {0, 0, -10}}}};
  const RodModes modes = rod_modes(dynamics.slopes(dynamics.rest(), {}, weight));
  EXPECT_GT(modes.eigenvalues.real().maxCoeff(), 1);
  EXPECT_EQ(modes.frequencies.size() + 1, static_cast<std::size_t>(dynamics.chain().size()));
}

TEST(RodModes, AreNumbersWhereTheRodIsFreeToTurn) {
  RodDynamicsSlopes slopes;
  slopes.mass = Eigen::Matrix2d::Identity();
  slopes.force_by_q = Eigen::Vector2d(0, -4).asDiagonal();
  slopes.force_by_v = Eigen::Matrix2d::Zero();
  const RodModes modes = rod_modes(slopes);
  ASSERT_EQ(modes.frequencies.size(), 1U);
  EXPECT_NEAR(modes.frequencies[0], 1 / std::numbers::pi, 1e-12);
  EXPECT_NEAR(std::abs(modes.eigenvalues[0]), 0, 1e-6);
  EXPECT_TRUE(modes.eigenvalues.allFinite());
}

}  // namespace
}  // namespace flexura
