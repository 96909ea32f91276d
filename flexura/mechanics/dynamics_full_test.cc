#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "flexura/mechanics/dynamics.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

namespace flexura {
namespace {

constexpr double all_pull_after = 0.2;  // s

struct Robot {
  explicit Robot(TestRandom& random) : rod(random_rod(random)), loads(random_loads(random, rod)) {
    tendons.tensions = random_tensions(random, rod, 8);
    for (EndLoad& end : loads.ends) end.following = false;  // Follower loads make rods flutter.
  }
  [[nodiscard]] TendonInput tendons_at(double time) const {
    TendonInput now = tendons;
    for (double& tension : now.tensions) tension *= std::min(1.0, time / all_pull_after);
    return now;
  }
  [[nodiscard]] RodLoads loads_at(double time) const {
    const double part = std::min(1.0, time / all_pull_after);
    RodLoads now = loads;
    now.gravity *= part;
    now.per_length *= part;
    for (EndLoad& end : now.ends) {
      end.force *= part;
      end.moment *= part;
    }
    return now;
  }
  Rod rod;
  RodLoads loads;
  TendonInput tendons;
};

// Undamped and slightly damped robots, pulled within 0.2 s, at camera steps. Some whip so that a step does
// not converge: this is reported, and the state stays valid.
TEST(DynamicsProperty, ManyRobotsMoveInTheStepsOfCameras) {
  long iterations = 0, steps = 0, anew = 0;
  int all = 0, given_up = 0;
  for_random_cases(200, [&](TestRandom& random) {
    Robot robot(random);
    const double damping_time = random.integer(0, 1) == 0 ? 0 : 1e-3;
    for (RodSection& section : robot.rod.sections) section.damping_time = damping_time;
    for (const double h : {0.01, 0.033}) {
      ++all;
      RodDynamics dynamics(robot.rod, {.tolerance = 1e-5});
      RodState state = dynamics.rest();
      while (state.time < 0.6) {
        const double now = state.time + h;
        const RodStep step = dynamics.step(state, robot.tendons_at(now), robot.loads_at(now), h);
        ASSERT_TRUE(state.q.allFinite() && state.momentum.allFinite());
        ++steps;
        iterations += step.iterations;
        anew += step.is_anew ? 1 : 0;
        if (!step.converged()) {
          ++given_up;
          break;
        }
      }
    }
  });
  EXPECT_LE(given_up, 0.01 * all);
  std::printf("%.2f iterations a step; %ld of %ld steps anew; %d of %d motions not to their end\n",
              static_cast<double>(iterations) / static_cast<double>(steps), anew, steps, given_up, all);
}

// Damped robots come to rest at the static equilibrium. Each step leaves an error of the rates up to the
// tolerance, so long steps only lead near to it: the last ones are short.
TEST(DynamicsProperty, ManyRobotsComeToRestInEquilibrium) {
  double worst = 0;
  int others = 0, all = 0;
  for_random_cases(60, [&](TestRandom& random) {
    Robot robot(random);
    for (RodSection& section : robot.rod.sections) section.damping_time = 0.05;
    for (EndLoad& end : robot.loads.ends) end.moment.setZero();
    RodDynamics dynamics(robot.rod, {.spectral_radius = 0, .tolerance = 1e-7});
    RodState state = dynamics.rest();
    while (state.time < 64) {
      const double h = state.time < 2 || state.time > 60 ? 0.02 : 0.2, now = state.time + h;
      const RodStep step = dynamics.step(state, robot.tendons_at(now), robot.loads_at(now), h);
      ASSERT_TRUE(step.converged()) << words(step.end) << " at " << state.time;
    }
    const Equilibrium at = RodStatics(robot.rod).solve(robot.tendons, robot.loads);
    ASSERT_TRUE(at.converged());
    ++all;
    // Another branch: reached where several equilibria exist, or by statics from this shape.
    RodStatics statics(robot.rod);
    Equilibrium near = at;
    near.q = state.q;
    const Equilibrium here = statics.solve(robot.tendons, robot.loads, near);
    ASSERT_TRUE(here.converged());
    if ((here.tip.position - at.tip.position).norm() > 1e-6) ++others;
    worst = std::max(worst, (dynamics.tip(state).position - here.tip.position).norm() / robot.rod.length());
    EXPECT_LE(worst, 1e-9);
  });
  std::printf("the farthest from equilibrium: %.1e of the length; %d of %d in another one\n", worst, others,
              all);
}

}  // namespace
}  // namespace flexura
