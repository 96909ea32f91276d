#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

// Tests of sections whose length is driven while the rod moves.
namespace flexura {
namespace {

Rod two_soft_sections(double youngs_modulus = 5e6) {
  Rod rod = soft_arm(youngs_modulus);
  rod.sections.push_back(rod.sections[0]);
  for (const std::size_t end : {0u, 1u})
    for (const double angle : {0.0, 120.0, 240.0})
      rod.tendons.push_back({.section = end, .radius = 0.007, .angle = angle * std::numbers::pi / 180});
  return rod;
}

// A straight rod of which each part is carried along.
TEST(DynamicsStretch, TheKineticEnergyIsThatOfWhatIsCarriedAlong) {
  RodDynamics dynamics(two_soft_sections());
  const double rate = 0.4, a_metre = dynamics.chain().rod().sections[0].mass_per_length_at(0), length = 0.3;
  const std::vector<double> factors = {1.2, 1}, rates = {rate, 0};
  dynamics.stretch_rest(factors, rates);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(dynamics.chain().size());
  const RodState state = dynamics.start(none, none, {}, {});
  const double speed = rate * length, first = a_metre * length;
  EXPECT_NEAR(dynamics.energy(state, {}).kinetic, 0.5 * first * speed * speed * (1.0 / 3 + 1), 1e-12);
  EXPECT_NEAR(dynamics.tip(state).position.z(), 0.3 * 1.2 + 0.3, 1e-12);
  EXPECT_NEAR(dynamics.momentum(state)[2], first * speed * 1.5, 1e-12);
  EXPECT_LE(dynamics.velocity(state).norm(), 1e-9);
  EXPECT_NEAR(dynamics.motion(state, {.section = 1}).twist[2], speed, 1e-12);
}

// Lagrange's equations: p = dT/dv, and the forces without stiffness are dT/dq.
TEST(DynamicsStretch, MomentaAndForcesAreThoseOfTheKineticEnergy) {
  for_random_cases(6, [](TestRandom& random) {
    Rod rod = random_rod(random);
    for (RodSection& section : rod.sections)
      section.modes = {.shear = 1, .stretch = 1, .bend = 2, .twist = 1};
    RodDynamics dynamics(rod);
    std::vector<double> factors, rates;
    for (std::size_t i = 0; i < rod.sections.size(); ++i) {
      factors.push_back(random.uniform(0.7, 1.4));
      rates.push_back(random.uniform(-1, 1));
    }
    dynamics.stretch_rest(factors, rates);
    const Eigen::Index n = dynamics.chain().size();
    Eigen::VectorXd q(n), v(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double size = dynamics.chain().scales()[j] == 1 ? 0.02 : 1 / dynamics.chain().scales()[j];
      q[j] = size * random.uniform(-1, 1);
      v[j] = size * random.uniform(-5, 5);
    }
    const auto kinetic = [&](const Eigen::VectorXd& at, const Eigen::VectorXd& rate) {
      return dynamics.energy(dynamics.start(at, rate, {}, {}), {}).kinetic;
    };
    const RodState state = dynamics.start(q, v, {}, {});
    EXPECT_LE((dynamics.velocity(state) - v).cwiseAbs().maxCoeff(), 1e-6 * v.cwiseAbs().maxCoeff());
    const Eigen::VectorXd inner = dynamics.stiffness_matrix() * q + dynamics.damping_matrix() * v;
    Eigen::VectorXd by_q(n), by_v(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double d = 1e-4 * (dynamics.chain().scales()[j] == 1 ? 0.02 : 1 / dynamics.chain().scales()[j]);
      Eigen::VectorXd more = q, less = q;
      more[j] += d, less[j] -= d;
      by_q[j] = (kinetic(more, v) - kinetic(less, v)) / (2 * d);
      more = less = v;
      more[j] += d, less[j] -= d;
      by_v[j] = (kinetic(q, more) - kinetic(q, less)) / (2 * d);
    }
    EXPECT_LE((state.momentum - by_v).cwiseAbs().maxCoeff(), 1e-6 * by_v.cwiseAbs().maxCoeff());
    EXPECT_LE((state.force + inner - by_q).cwiseAbs().maxCoeff(),
              1e-6 * by_q.cwiseAbs().maxCoeff() + 1e-12 * inner.cwiseAbs().maxCoeff());
  });
}

// A driven rod comes to rest at the static equilibrium, also with held tendons.
TEST(DynamicsStretch, ComesToRestWhereTheStaticsSays) {
  Rod rod = two_soft_sections(2e7);
  for (RodSection& section : rod.sections) section.damping_time = 0.2;
  const RodLoads weight{.gravity = {-9.81, 0, 0}};
  const std::vector<double> longer = {1.25, 0.9};
  TendonInput held{.displacements = {-0.06, -0.07, -0.07, -0.02, -0.04, -0.04}};
  for (const bool is_held : {false, true}) {
    const TendonInput input = is_held ? held : TendonInput{};
    RodStatics statics(rod);
    RodDynamics dynamics(rod);
    RodState state = dynamics.rest();
    const double h = 0.01;
    for (int i = 0; i < 1000; ++i) {
      const double middle = state.time + h / (1 + RodDynamicsConfig{}.spectral_radius),
                   part = std::min(middle, 1.0);
      const double going = state.time + h / 2 < 1 ? 1 : 0;
      const std::vector<double> now = {1 + part * 0.25, 1 - part * 0.1}, rates = {going * 0.25, going * -0.1};
      dynamics.stretch_rest(now, rates);
      ASSERT_TRUE(dynamics.step(state, input, weight, h).converged());
    }
    statics.stretch_rest(longer);
    const Equilibrium known = statics.solve(input, weight);
    ASSERT_TRUE(known.converged());
    EXPECT_LE((dynamics.tip(state).position - known.tip.position).norm(), 1e-5) << is_held;
  }
}

TEST(DynamicsStretch, ErrorsFallWithTheSquareOfTheStep) {
  const auto tip = [](double h) {
    Rod rod = two_soft_sections();
    for (RodSection& section : rod.sections) section.modes.shear = section.modes.stretch = 0;
    RodDynamics dynamics(rod, {.spectral_radius = 0.8});
    RodState state =
        dynamics.start(Eigen::VectorXd::Zero(dynamics.chain().size()),
                       Eigen::VectorXd::Zero(dynamics.chain().size()), {}, {.gravity = {-9.81, 0, 0}});
    const auto drive = [&](double t) {
      const std::vector<double> now = {1 + 0.1 * std::pow(std::sin(5 * t), 2), 1},
                                rates = {0.5 * std::sin(10 * t), 0};
      dynamics.stretch_rest(now, rates);
    };
    for (long i = 0; i < std::lround(0.32 / h); ++i) {
      drive(state.time + h / 1.8);
      EXPECT_TRUE(dynamics.step(state, {}, {.gravity = {-9.81, 0, 0}}, h).converged());
    }
    drive(0.32);
    return dynamics.tip(state).position;
  };
  const Eigen::Vector3d exact = tip(2.5e-4);
  const double coarse = (tip(4e-3) - exact).norm(), fine = (tip(2e-3) - exact).norm();
  EXPECT_NEAR(coarse / fine, 4, 1);
}

TEST(DynamicsStretch, RefusesWhatIsNoStretch) {
  RodDynamics dynamics(two_soft_sections());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refuses = [&](const std::vector<double>& factors, const std::vector<double>& rates) {
    EXPECT_THROW(dynamics.stretch_rest(factors, rates), std::invalid_argument);
  };
  refuses({1}, {0});
  refuses({1, 0}, {0, 0});
  refuses({1, nan}, {0, 0});
  refuses({1, 1}, {0, nan});
}

}  // namespace
}  // namespace flexura
