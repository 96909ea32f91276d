#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

// Tests of tendon friction in motion.
namespace flexura {
namespace {

constexpr double rubs_by = 0.3, off_axis = 0.05;

// An evenly bending, strongly damped rod with one tendon that has friction.
Rod rubbing_rod(int modes = 1) {
  Rod rod = elastica(modes);
  rod.sections[0].damping_time = 2;
  rod.tendons = {{.section = 0, .radius = off_axis, .friction = rubs_by}};
  return rod;
}

double bend_of(const RodDynamics& dynamics, const RodState& state) {
  return state.q[dynamics.chain().elements()[0].grid().first[4]];
}

// Steps through a linear tension ramp followed by constant tension.
void pull_tendon(RodDynamics& dynamics, RodState& state, double from, double to, double ramp, double rest,
                 double h = 0.05) {
  const double start = state.time;
  while (state.time < start + ramp + rest - h / 2) {
    const double part = std::min(1.0, (state.time + h / 2 - start) / ramp);
    const RodStep step = dynamics.step(state, {.tensions = {from + part * (to - from)}}, {}, h);
    ASSERT_TRUE(step.converged()) << state.time;
    ASSERT_GE(step.friction_loss, -1e-12);
  }
}

// Solves EI bend = mean of T d exp(-+mu s bend) over the length for the tension (L. Euler, J. Eytelwein).
double pull_for(double bend, double mu) {
  return mu == 0 ? bend / off_axis : bend * mu * bend / (off_axis * (1 - std::exp(-mu * bend)));
}

TEST(DynamicsFriction, OfAnEvenBendIsThatOfACapstan) {
  RodDynamics dynamics(rubbing_rod());
  RodState state = dynamics.rest();
  pull_tendon(dynamics, state, 0, 30, 40, 60);
  const double pulled_in = bend_of(dynamics, state);
  EXPECT_NEAR(pull_for(pulled_in, rubs_by), 30, 0.1);
  const Equilibrium known = RodStatics(rubbing_rod()).solve({.tensions = {30}}, {});
  EXPECT_NEAR(pulled_in, known.q[dynamics.chain().elements()[0].grid().first[4]], 2e-3);
  // Lets the tendon out to 20 N, starting from larger displacement.
  pull_tendon(dynamics, state, 30, 40, 20, 40);
  pull_tendon(dynamics, state, 40, 20, 60, 60);
  EXPECT_NEAR(pull_for(bend_of(dynamics, state), -rubs_by), 20, 0.1);
}

TEST(DynamicsFriction, ATendonThatIsPulledToAndFroGoesAroundALoop) {
  RodDynamics dynamics(rubbing_rod(3));
  RodState state = dynamics.rest();
  pull_tendon(dynamics, state, 0, 20, 60, 40);
  const double first = bend_of(dynamics, state);
  pull_tendon(dynamics, state, 20, 40, 60, 0);
  const double top = bend_of(dynamics, state);
  pull_tendon(dynamics, state, 40, 20, 60, 40);
  const double back = bend_of(dynamics, state);
  EXPECT_GT(back, 1.1 * first);
  EXPECT_LT(back, top);
  // A second loop ends at the same shape.
  pull_tendon(dynamics, state, 20, 0.5, 60, 40);
  pull_tendon(dynamics, state, 0.5, 20, 60, 40);
  EXPECT_NEAR(bend_of(dynamics, state), first, 0.02 * first);
  pull_tendon(dynamics, state, 20, 40, 60, 0);
  EXPECT_NEAR(bend_of(dynamics, state), top, 0.02 * top);
}

// A swinging rod comes to rest between the equilibria of a tendon pulled in and let out.
TEST(DynamicsFriction, ComesToRestInTheBandOfTheStatics) {
  Rod rod = rubbing_rod(3);
  rod.sections[0].damping_time = 0.05;
  RodDynamics dynamics(rod);
  RodState state = dynamics.rest();
  for (int i = 0; i < 1600; ++i) ASSERT_TRUE(dynamics.step(state, {.tensions = {20}}, {}, 0.02).converged());
  EXPECT_LT(dynamics.energy(state, {}).kinetic, 1e-12);
  const double bend = bend_of(dynamics, state);
  const Equilibrium inwards = RodStatics(rod).solve({.tensions = {20}}, {});
  rod.tendons[0].friction = 0;
  const Equilibrium without = RodStatics(rod).solve({.tensions = {20}}, {});
  const Eigen::Index at = dynamics.chain().elements()[0].grid().first[4];
  EXPECT_GE(bend, inwards.q[at] - 1e-6);
  EXPECT_LE(bend, without.q[at] + (without.q[at] - inwards.q[at]) * 1.5);
  // It stays there.
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(dynamics.step(state, {.tensions = {20}}, {}, 0.05).converged());
  EXPECT_NEAR(bend_of(dynamics, state), bend, 1e-9);
}

TEST(DynamicsFriction, WhatIsAtRestStays) {
  for_random_cases(10, [](TestRandom& random) {
    Rod rod = random_rod(random, 0.3);
    const bool has_disks = random.integer(0, 1) == 0;
    for (RodSection& section : rod.sections) {
      section.damping_time = 0.01;
      if (has_disks) section.disks = 4;
    }
    const std::vector<double> tensions = random_tensions(random, rod, 3);
    const Equilibrium at = RodStatics(rod).solve({.tensions = tensions}, {});
    if (!at.converged() || !at.stable) return;
    for (const bool by_displacement : {false, true}) {
      RodDynamics dynamics(rod);
      RodState state = dynamics.rest(at);
      const TendonInput input = by_displacement ? TendonInput{.displacements = at.displacements}
                                                : TendonInput{.tensions = tensions};
      for (int i = 0; i < 20; ++i) ASSERT_TRUE(dynamics.step(state, input, {}, 0.01).converged());
      EXPECT_LE((dynamics.tip(state).position - at.tip.position).norm(), 1e-6 * rod.length())
          << by_displacement;
    }
  });
}

struct RubbingRobot {
  explicit RubbingRobot(TestRandom& random) : rod(random_rod(random, 0.5)) {
    const bool has_disks = random.integer(0, 2) == 0;
    for (RodSection& section : rod.sections) {
      section.modes = {.shear = 0, .stretch = 1, .bend = 3, .twist = 1};
      section.damping_time = random.uniform(0, 0.01);
      if (has_disks) section.disks = 3;
    }
    tendons.tensions = random_tensions(random, rod, 5);
    const RodChain chain(rod);
    q.resize(chain.size());
    v.resize(chain.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const bool is_long = chain.scales()[j] == 1;
      q[j] = (is_long ? 0.02 : 1) * random.uniform(-1, 1) / chain.scales()[j];
      v[j] = (is_long ? 0.02 : 1) * random.uniform(-5, 5) / chain.scales()[j];
    }
  }
  Rod rod;
  TendonInput tendons;
  Eigen::VectorXd q, v;
};

// Jacobian by differences so small that no tendon reverses in between.
Eigen::MatrixXd jacobian_of(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& f,
                            const Eigen::VectorXd& x) {
  Eigen::MatrixXd J(x.size(), x.size());
  for (Eigen::Index j = 0; j < x.size(); ++j) {
    const double d = 1e-6 * std::max(1.0, std::abs(x[j]));
    Eigen::VectorXd more = x, less = x;
    more[j] += d, less[j] -= d;
    J.col(j) = (f(more) - f(less)) / (2 * d);
  }
  return J;
}

TEST(DynamicsFriction, ItsDerivativesAreThoseByDifferences) {
  for_random_cases(8, [](TestRandom& random) {
    const RubbingRobot robot(random);
    RodDynamics dynamics(robot.rod);
    const RodLoads weight{.gravity = {0, -9.81, 0}};
    const auto force = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& v, const TendonInput& tendons) {
      return dynamics.start(q, v, tendons, weight).force;
    };
    const RodState state = dynamics.start(robot.q, robot.v, robot.tendons, weight);
    const RodDynamicsSlopes by = dynamics.slopes(state, robot.tendons, weight);
    const auto expect_same = [](const Eigen::MatrixXd& found, const Eigen::MatrixXd& known) {
      EXPECT_LE((found - known).cwiseAbs().maxCoeff(), 1e-5 * std::max(1e-6, known.cwiseAbs().maxCoeff()));
    };
    expect_same(
        by.force_by_q,
        jacobian_of([&](const Eigen::VectorXd& q) { return force(q, robot.v, robot.tendons); }, robot.q));
    expect_same(
        by.force_by_v,
        jacobian_of([&](const Eigen::VectorXd& v) { return force(robot.q, v, robot.tendons); }, robot.v));
    for (std::size_t i = 0; i < robot.tendons.tensions.size(); ++i) {
      if (robot.tendons.tensions[i] == 0) continue;
      TendonInput more = robot.tendons, less = robot.tendons;
      more.tensions[i] += 1e-5, less.tensions[i] -= 1e-5;
      expect_same(by.force_by_input.col(static_cast<Eigen::Index>(i)),
                  (force(robot.q, robot.v, more) - force(robot.q, robot.v, less)) / 2e-5);
    }
  });
}

TEST(DynamicsFriction, TheDerivativesOfAStepAreThoseByDifferences) {
  for_random_cases(4, [](TestRandom& random) {
    const RubbingRobot robot(random);
    RodDynamics dynamics(robot.rod, {.tolerance = 1e-11});
    const RodState state = dynamics.start(robot.q, 0.2 * robot.v, robot.tendons, {});
    const double h = 1e-3;
    const RodStepSlopes slopes = dynamics.step_slopes(state, robot.tendons, {}, h);
    const Eigen::Index n = state.q.size();
    const auto after = [&](const RodState& from) {
      RodState to = from;
      EXPECT_TRUE(dynamics.step(to, robot.tendons, {}, h).converged());
      Eigen::VectorXd all(2 * n);
      all << to.q, to.momentum;
      return all;
    };
    for (Eigen::Index j = 0; j < n; ++j) {
      // Smaller differences of momenta of light modes are mostly rounding.
      const double d = 1e-5 * std::max(1.0, std::abs(state.q[j]));
      RodState more = state, less = state;
      more.q[j] += d, less.q[j] -= d;
      const Eigen::VectorXd known = (after(more) - after(less)) / (2 * d);
      const Eigen::VectorXd found = slopes.by_state.col(j).head(2 * n);
      for (Eigen::Index part : {Eigen::Index{0}, n})
        EXPECT_LE((found - known).segment(part, n).cwiseAbs().maxCoeff(),
                  1e-4 * std::max(1e-9, known.segment(part, n).cwiseAbs().maxCoeff()));
    }
  });
}

// Friction never adds energy for any tensions and displacements, and its work balances the energy.
TEST(DynamicsFriction, NeverGivesEnergy) {
  for_random_cases(20, [](TestRandom& random) {
    const RubbingRobot robot(random);
    RodDynamics dynamics(robot.rod);
    RodState state = dynamics.rest();
    const bool by_displacement = random.integer(0, 1) == 0;
    TendonInput input;
    for (int i = 0; i < 60; ++i) {
      if (i % 10 == 0) {
        if (by_displacement) {
          input.displacements.assign(robot.rod.tendons.size(), 0.0);
          for (double& each : input.displacements) each = random.uniform(-2e-3, 2e-3);
        } else {
          input.tensions = random_tensions(random, robot.rod, 4);
        }
      }
      const RodStep step = dynamics.step(state, input, {}, 4e-3);
      ASSERT_TRUE(step.converged()) << i << " " << by_displacement;
      EXPECT_GE(step.friction_loss, -1e-13 - 1e-9 * std::abs(step.friction_work));
      for (const double tension : state.tensions) EXPECT_GE(tension, 0);
    }
  });
}

TEST(DynamicsFriction, WhatTheTendonGivesIsWhatTheRodAndFrictionHave) {
  Rod rod = rubbing_rod(3);
  rod.sections[0].damping_time = 0;
  const auto missing = [&](double h) {
    RodDynamics dynamics(rod, {.spectral_radius = 1});
    RodState state = dynamics.rest();
    double given = 0, rubbed = 0, before = dynamics.tendon_lengths(state)[0];
    for (long i = 0; i < std::lround(4 / h); ++i) {
      const double tension = 15 + 10 * std::sin(2 * (state.time + h / 2));
      const RodStep step = dynamics.step(state, {.tensions = {tension}}, {}, h);
      EXPECT_TRUE(step.converged());
      const double length = dynamics.tendon_lengths(state)[0];
      given += tension * (before - length);
      before = length;
      rubbed += step.friction_work;
    }
    EXPECT_GT(rubbed, 0.01 * given);
    return std::abs(dynamics.energy(state, {}).total() + rubbed - given);
  };
  const double coarse = missing(0.01);
  EXPECT_LE(coarse, 2e-3);
  EXPECT_LE(missing(0.0025), coarse / 3);
}

TEST(DynamicsFriction, ConvergesWithTheStep) {
  Rod rod = rubbing_rod(3);
  rod.sections[0].damping_time = 0.05;
  const auto bend = [&](double h) {
    RodDynamics dynamics(rod);
    RodState state = dynamics.rest();
    const double middle = h / (1 + RodDynamicsConfig{}.spectral_radius);
    for (long i = 0; i < std::lround(4.8 / h); ++i) {
      const double tension = 15 + 10 * std::sin(2 * (state.time + middle));
      EXPECT_TRUE(dynamics.step(state, {.tensions = {tension}}, {}, h).converged());
    }
    return bend_of(dynamics, state);
  };
  const double exact = bend(0.0005), coarse = std::abs(bend(0.016) - exact),
               fine = std::abs(bend(0.004) - exact);
  EXPECT_LE(fine, coarse / 3);
  EXPECT_LE(fine, 2e-3);
}

// With alternating displacements the tension is higher inwards than outwards.
TEST(DynamicsFriction, PullsByMoreOnItsWayIn) {
  RodDynamics dynamics(rubbing_rod(3));
  RodState state = dynamics.rest();
  const auto go = [&](double from, double to) {
    const double start = state.time;
    while (state.time < start + 30) {
      const double part = std::min(1.0, (state.time + 0.05 - start) / 20);
      ASSERT_TRUE(dynamics.step(state, {.displacements = {from + part * (to - from)}}, {}, 0.1).converged());
    }
  };
  go(0, 0.04);
  const double in = state.tensions[0];
  go(0.04, 0.06);
  go(0.06, 0.04);
  const double out = state.tensions[0], bend = 0.04 / off_axis;
  EXPECT_NEAR(in, pull_for(bend, rubs_by), 0.05 * in);
  EXPECT_NEAR(out, pull_for(bend, -rubs_by), 0.05 * out);
}

TEST(DynamicsFriction, HasNoLinearModel) {
  RodDynamics dynamics(rubbing_rod());
  EXPECT_THROW((void)dynamics.linearize(dynamics.rest(), {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
