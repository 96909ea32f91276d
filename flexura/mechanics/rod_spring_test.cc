#include "flexura/mechanics/rod_spring.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/statics.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

PointSpring random_spring(TestRandom& random) {
  return {.to = random.vector<3>(-1, 1),
          .stiffness = random.uniform(0, 30),
          .most = random.uniform(0.5, 20),
          .force = random.vector<3>(-1, 1)};
}

TEST(RodSpring, ItsDerivativeIsThatByDifferences) {
  for_random_cases(50, [](TestRandom& random) {
    const PointSpring spring = random_spring(random);
    const Eigen::Vector3d p = random.vector<3>(-1, 1);
    const SpringPull pull = spring_pull(spring, p);
    constexpr double h = 1e-6;
    for (int i = 0; i < 6; ++i) {
      const auto moved = [&](double step) {
        Vector6d twist = Vector6d::Zero();
        twist[i] = step;
        return spring_pull(spring, p + twist.head<3>() + twist.tail<3>().cross(p)).wrench;
      };
      EXPECT_LE(((moved(h) - moved(-h)) / (2 * h) - pull.by_pose.col(i)).norm(), 1e-6);
    }
    const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(pull.stiffness);
    EXPECT_GE(eigen.eigenvalues().minCoeff(), -1e-9);
  });
}

TEST(RodSpring, PullsNoMoreThanItsMost) {
  const PointSpring spring{.to = {1e6, 0, 0}, .stiffness = 10, .most = 2};
  EXPECT_NEAR(spring_force(spring, {0, 0, 0}).norm(), 2, 1e-9);
  EXPECT_NEAR(spring_force({.to = {1e-3, 0, 0}, .stiffness = 10, .most = 2}, {0, 0, 0}).x(), 1e-2, 1e-6);
}

TEST(RodSpring, SaysWhatIsWrongWithIt) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(spring_problem({}), "");
  EXPECT_NE(spring_problem({.to = {nan, 0, 0}}), "");
  EXPECT_NE(spring_problem({.stiffness = -1}), "");
  EXPECT_NE(spring_problem({.most = 0}), "");
  EXPECT_NE(spring_problem({.at = 1.1}), "");
  RodStatics statics(soft_arm());
  RodLoads loads;
  loads.springs = {{.force = {nan, 0, 0}}};
  EXPECT_EQ(statics.solve({}, loads).end, StaticsEnd::bad_input);
  loads.springs = {{.section = 1}};
  EXPECT_EQ(statics.solve({}, loads).end, StaticsEnd::bad_input);
  RodDynamics dynamics(soft_arm());
  RodState state = dynamics.rest();
  EXPECT_EQ(dynamics.step(state, {}, loads, 1e-3).end, DynamicsEnd::bad_input);
}

// A force at the end equals an end load; a force further in bends a light cantilever as in beam theory.
TEST(RodSpring, BendsACantileverAsAForceThereDoes) {
  const Rod rod = soft_arm();
  RodLoads at_end, by_spring;
  at_end.ends = {{.section = 0, .force = {0.2, 0, 0}}};
  by_spring.springs = {{.force = {0.2, 0, 0}}};
  RodStatics statics(rod);
  const Eigen::Vector3d tip = statics.solve({}, at_end).tip.position;
  EXPECT_LE((statics.solve({}, by_spring).tip.position - tip).norm(), 1e-9);

  constexpr double part = 0.37, force = 1e-3;
  RodStatics inner(rod, std::array{RodPlace{0, part}});
  by_spring.springs = {{.at = part, .force = {force, 0, 0}}};
  const Equilibrium at = inner.solve({}, by_spring);
  ASSERT_TRUE(at.converged());
  const double a = part * 0.3, stiffness = rod.sections[0].stiffness_at(0)[3];
  const double aside = force * a * a * (3 * 0.3 - a) / (6 * stiffness);
  EXPECT_NEAR(at.tip.position.x(), aside, 0.02 * aside);
}

// At rest the spring's force balances the arm's.
TEST(RodSpring, DrawsThePointUntilBothAreEven) {
  RodLoads loads;
  loads.springs = {{.to = {0.15, 0.05, 0.35}, .stiffness = 20, .most = 5}};
  RodStatics statics(soft_arm());
  const Equilibrium drawn = statics.solve({}, loads);
  ASSERT_TRUE(drawn.converged());
  RodLoads even;
  even.ends = {{.section = 0, .force = spring_force(loads.springs[0], drawn.tip.position)}};
  EXPECT_LE((statics.solve({}, even, drawn).tip.position - drawn.tip.position).norm(), 1e-8);
  EXPECT_GT(drawn.tip.position.x(), 0.03);
}

TEST(RodSpring, LetsARodInMotionSettleWhereItRests) {
  Rod rod = soft_arm();
  rod.sections[0].damping_time = 0.1;
  const PointSpring spring{.at = 0.7, .to = {0.1, 0.02, 0.2}, .stiffness = 20, .most = 5};
  const std::array places{RodPlace{0, spring.at}};
  RodLoads loads;
  loads.springs = {spring};
  RodStatics statics(rod, places);
  const Equilibrium rest = statics.solve({}, loads);
  ASSERT_TRUE(rest.converged());
  RodDynamics dynamics(rod, {}, places);
  RodSpring hand(dynamics.chain(), places[0]);
  EXPECT_THROW(hand.set(PointSpring{.stiffness = -1}), std::invalid_argument);
  dynamics.set_surroundings(&hand);
  RodState state = dynamics.rest();
  hand.set(spring);
  for (int i = 0; i < 800; ++i) ASSERT_TRUE(dynamics.step(state, {}, {}, 5e-3).converged());
  EXPECT_LE((dynamics.tip(state).position - rest.tip.position).norm(), 1e-4);
  hand.set(std::nullopt);
  for (int i = 0; i < 800; ++i) ASSERT_TRUE(dynamics.step(state, {}, {}, 5e-3).converged());
  EXPECT_LE(dynamics.tip(state).position.head<2>().norm(), 1e-3);
}

}  // namespace
}  // namespace flexura
