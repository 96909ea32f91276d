#include "flexura/mechanics/dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

namespace flexura {
namespace {

constexpr StrainModes plane_bends{.shear = 0, .stretch = 0, .bend = 8, .twist = 0, .planar = true};

Rod bending_heavy_rod(int modes = 8) {
  Rod rod = heavy_rod();
  rod.sections[0].modes = plane_bends;
  rod.sections[0].modes.bend = modes;
  return rod;
}

// Makes this number of steps and expects convergence.
void go(RodDynamics& dynamics, RodState& state, const TendonInput& tendons, const RodLoads& loads, double h,
        double until) {
  const long steps = std::lround((until - state.time) / h);
  for (long i = 0; i < steps; ++i) {
    const RodStep step = dynamics.step(state, tendons, loads, h);
    ASSERT_TRUE(step.converged()) << words(step.end) << " at " << state.time;
  }
}

Eigen::Vector3d tip_of_tentacle(const Rod& rod, const RodDynamicsConfig& config, double h, double until) {
  RodDynamics dynamics(rod, config);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(dynamics.chain().size());
  RodState state = dynamics.start(none, none, {}, soft_tentacle_weight());
  go(dynamics, state, {}, soft_tentacle_weight(), h, until);
  return dynamics.tip(state).position;
}

// Lowest frequencies by the eigenvalues of stiffness and mass at rest.
std::vector<double> frequencies(const Rod& rod) {
  RodDynamics dynamics(rod);
  const RodDynamicsSlopes slopes = dynamics.slopes(dynamics.rest(), {}, {});
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(-slopes.force_by_q, slopes.mass,
                                                                        Eigen::EigenvaluesOnly);
  std::vector<double> result;
  for (const double square : eigen.eigenvalues())
    result.push_back(std::sqrt(square) / (2 * std::numbers::pi));
  return result;
}

// Frequencies of Euler's and Bernoulli's rod. Rotary inertia lowers them by about (wave number x radius /
// 2)^2 / 2.
TEST(Dynamics, ARodHasTheFrequenciesOfEulerAndBernoulli) {
  const std::vector<double> found = frequencies(bending_heavy_rod(18));
  const std::vector<double> known = {5.595912, 35.068983, 98.194166, 192.421376};
  for (std::size_t i = 0; i < known.size(); ++i) {
    EXPECT_LT(found[i], known[i]);
    EXPECT_NEAR(found[i], known[i], 1e-4 * known[i]);
  }
  Rod slender = bending_heavy_rod(18);
  slender.sections[0].radius = {1e-5, 1e-5};
  slender.sections[0].youngs_modulus *= 1e4;  // Leaves the frequencies unchanged.
  const std::vector<double> thin = frequencies(slender);
  for (std::size_t i = 0; i < known.size(); ++i) EXPECT_NEAR(thin[i], known[i], 1e-6 * known[i]);
}

// The heavy rod, held level by a mass of 20 g at its tip, which is released.
TEST(Dynamics, ALoadThatFallsOffLeavesTheRodToItself) {
  const RodLoads weight{.gravity = {-9.81, 0, 0}};
  RodLoads loaded = weight;
  loaded.ends = {{.section = 0, .force = {-0.02 * 9.81, 0, 0}}};
  const Rod rod = bending_heavy_rod();
  RodDynamics dynamics(rod, {.spectral_radius = 1});
  RodState state = dynamics.rest(RodStatics(rod).solve({}, loaded));
  EXPECT_NEAR(dynamics.tip(state).position.x(), -0.06330, 5e-6);
  EXPECT_NEAR(dynamics.energy(state, weight).total(), 0.004666482, 1e-9);
  struct Known {
    double time, x;
  };
  for (const Known& known :
       {Known{0.05, -0.00301}, Known{0.1, 0.03526}, Known{0.25, 0.02807}, Known{0.5, -0.02634}}) {
    go(dynamics, state, {}, weight, 1e-4, known.time);
    EXPECT_NEAR(dynamics.tip(state).position.x(), known.x, 5e-5);
  }
}

TEST(Dynamics, ASoftTentacleSwingsAndComesToRest) {
  Rod rod = soft_tentacle();
  rod.sections[0].modes.bend = 8;
  RodDynamics dynamics(rod, {.spectral_radius = 0.8});
  const RodLoads weight = soft_tentacle_weight();
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(dynamics.chain().size());
  RodState state = dynamics.start(none, none, {}, weight);
  go(dynamics, state, {}, weight, 1e-3, 0.25);
  EXPECT_LE((dynamics.tip(state).position - Eigen::Vector3d(-0.352721, 0, 0.467438)).norm(), 1e-5);
  go(dynamics, state, {}, weight, 1e-3, 0.5);
  EXPECT_LE((dynamics.tip(state).position - Eigen::Vector3d(-0.519303, 0, 0.078858)).norm(), 1e-5);
  go(dynamics, state, {}, weight, 1e-2, 80);
  EXPECT_LE((dynamics.tip(state).position - Eigen::Vector3d(-0.410992, 0, 0.405004)).norm(), 1e-5);
  const Equilibrium rest = RodStatics(rod).solve({}, weight);
  EXPECT_LE((dynamics.tip(state).position - rest.tip.position).norm(), 1e-9 * rod.length());
}

TEST(Dynamics, ErrorsFallWithTheSquareOfTheStep) {
  for (const double rho : {0.0, 0.3, 0.8, 1.0}) {
    const RodDynamicsConfig config{.spectral_radius = rho};
    const auto tip = [&](double h) { return tip_of_tentacle(soft_tentacle(), config, h, 0.32); };
    const Eigen::Vector3d exact = tip(2.5e-4);
    const double coarse = (tip(8e-3) - exact).norm(), fine = (tip(4e-3) - exact).norm(),
                 finest = (tip(2e-3) - exact).norm();
    EXPECT_NEAR(coarse / fine, 4, 1) << rho;
    EXPECT_NEAR(fine / finest, 4, 0.5) << rho;
  }
}

TEST(Dynamics, EachModeMoreComesNearer) {
  const auto tip = [](int modes) {
    Rod rod = soft_tentacle();
    rod.sections[0].modes.bend = modes;
    return tip_of_tentacle(rod, {}, 5e-3, 0.3);
  };
  const Eigen::Vector3d exact = tip(9);
  double before = 1;
  for (const int modes : {2, 3, 4, 6}) {
    const double error = (tip(modes) - exact).norm();
    EXPECT_LT(error, 0.6 * before) << modes;
    before = error;
  }
  EXPECT_LE(before, 3e-6);
}

TEST(Dynamics, TheErrorOfAStepIsToldToFirstOrder) {
  RodDynamics dynamics(soft_tentacle(), {.spectral_radius = 0.8}),
      finer(soft_tentacle(), {.spectral_radius = 0.8});
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(dynamics.chain().size());
  const RodLoads weight = soft_tentacle_weight();
  double reported = 0;
  RodState state = dynamics.start(none, none, {}, weight), exact = state;
  EXPECT_EQ(dynamics.step_error(state), 0);
  for (int i = 0; i < 50; ++i) {
    ASSERT_TRUE(dynamics.step(state, {}, weight, 4e-3).converged());
    reported += dynamics.step_error(state);
  }
  go(finer, exact, {}, weight, 2e-4, 0.2);
  const double error = (dynamics.tip(state).position - finer.tip(exact).position).norm();
  EXPECT_LT(error, 3 * reported);
  EXPECT_GT(error, 0.1 * reported);
}

// Energy is conserved without drift for 10 s in steps of 0.1 ms.
TEST(Dynamics, WithoutDampingEnergyStays) {
  const RodLoads weight{.gravity = {-9.81, 0, 0}};
  RodLoads loaded = weight;
  loaded.ends = {{.section = 0, .force = {-0.02 * 9.81, 0, 0}}};
  const Rod rod = bending_heavy_rod(5);
  RodDynamics dynamics(rod, {.spectral_radius = 1});
  RodState state = dynamics.rest(RodStatics(rod).solve({}, loaded));
  const double energy = dynamics.energy(state, weight).total();
  double first = 0, last = 0;
  for (int i = 1; i <= 1000; ++i) {
    go(dynamics, state, {}, weight, 1e-4, 0.01 * i);
    const double change = std::abs(dynamics.energy(state, weight).total() - energy);
    (i <= 500 ? first : last) = std::max(i <= 500 ? first : last, change);
  }
  EXPECT_LE(std::max(first, last), 1e-6 * energy);
  EXPECT_LE(last, 1.2 * first);
}

// The energy changes by the work of damping and tendons.
TEST(Dynamics, PowerIsBalanced) {
  Rod rod = two_section_robot();
  for (RodSection& section : rod.sections) {
    section.density = 5000;
    section.damping_time = 1e-3;
    section.modes = {.shear = 1, .stretch = 1, .bend = 3, .twist = 1};
  }
  const RodLoads weight{.gravity = {3, -9, 1}};
  RodDynamics dynamics(rod, {.spectral_radius = 1});
  RodState state = dynamics.rest();
  double work = 0, lost = 0;
  std::vector<double> lengths = dynamics.tendon_lengths(state);
  const double h = 1e-4, begin = dynamics.energy(state, weight).total();
  for (int i = 0; i < 1000; ++i) {
    const double t = (i + 0.5) * h;
    const TendonInput tendons{.tensions = {10 * t, 0, 20 * t * t, 0, 5 * t, 0}};
    const Eigen::VectorXd before = state.q;
    ASSERT_TRUE(dynamics.step(state, tendons, weight, h).converged());
    const std::vector<double> now = dynamics.tendon_lengths(state);
    for (std::size_t j = 0; j < now.size(); ++j) work -= tendons.tensions[j] * (now[j] - lengths[j]);
    lengths = now;
    lost +=
        h * dynamics.dissipation(dynamics.start(0.5 * (before + state.q), (state.q - before) / h, {}, {}));
  }
  const double change = dynamics.energy(state, weight).total() - begin;
  EXPECT_GT(work, 1e-4);
  EXPECT_GT(lost, 1e-5);
  EXPECT_NEAR(change, work - lost, 1e-4 * lost);
}

TEST(Dynamics, GravityPullsAtTheMomentum) {
  for_random_cases(5, [](TestRandom& random) {
    const Rod rod = random_rod(random);
    RodDynamics dynamics(rod);
    const Eigen::VectorXd scales = dynamics.chain().scales();
    Eigen::VectorXd q(scales.size()), v(scales.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const double size = j % 17 < 3 ? 0.02 : 0.5;
      q[j] = size * random.uniform(-1, 1) / scales[j];
      v[j] = size * random.uniform(-1, 1) / scales[j];
    }
    const RodLoads weight{.gravity = random.vector<3>(-9, 9)};
    const double h = 1e-6;
    const auto height = [&](double t) {
      return dynamics.energy(dynamics.start(q + t * v, v, {}, {}), weight).gravity;
    };
    const Vector6d momentum = dynamics.momentum(dynamics.start(q, v, {}, {}));
    EXPECT_NEAR((height(h) - height(-h)) / (2 * h), -weight.gravity.dot(momentum.head<3>()), 1e-8);
  });
}

// An equilibrium does not move, by tensions or displacements, in channels or between disks.
TEST(Dynamics, WhatIsAtRestStays) {
  for_random_cases(24, [](TestRandom& random) {
    Rod rod = random_rod(random);
    const bool has_disks = random.integer(0, 3) == 0;
    for (RodSection& section : rod.sections) {
      section.damping_time = 1e-3;
      if (has_disks) section.disks = 5;
    }
    for (TendonRoute& tendon : rod.tendons) tendon.compliance = random.integer(0, 1) == 0 ? 0 : 1e-4;
    const RodLoads loads = random_loads(random, rod);
    TendonInput tendons{.tensions = random_tensions(random, rod, 5)};
    RodStatics statics(rod);
    Equilibrium at = statics.solve(tendons, loads);
    ASSERT_TRUE(at.converged());
    if (random.integer(0, 1) == 0) {
      tendons = {.displacements = at.displacements};
      at = statics.solve(tendons, loads, at);
      ASSERT_TRUE(at.converged());
    }
    if (!at.stable) return;
    RodDynamics dynamics(rod, {.spectral_radius = 0});
    RodState state = dynamics.rest(at);
    for (int i = 0; i < 20; ++i) {
      const RodStep step = dynamics.step(state, tendons, loads, 0.01);
      ASSERT_TRUE(step.converged());
      EXPECT_EQ(step.pieces, 1);
    }
    EXPECT_LE((dynamics.tip(state).position - at.tip.position).norm(), 1e-9 * rod.length());
    for (std::size_t i = 0; i < at.tensions.size(); ++i) EXPECT_NEAR(state.tensions[i], at.tensions[i], 1e-5);
  });
}

// A rod turned about z with its loads and tendons moves in the same way.
TEST(Dynamics, NothingDependsOnHowTheBaseIsTurned) {
  const double angle = 0.7;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Rod rod = two_section_robot(), turned = rod;
  for (Rod* one : {&rod, &turned})
    for (RodSection& section : one->sections) {
      section.density = 6000;
      section.damping_time = 1e-3;
    }
  for (TendonRoute& tendon : turned.tendons) tendon.angle += angle;
  const RodLoads loads{.gravity = {2, 5, -8}, .ends = {{.section = 1, .force = {0.02, 0, 0.01}}}},
      turned_loads{.gravity = turn * loads.gravity,
                   .ends = {{.section = 1, .force = turn * loads.ends[0].force}}};
  const TendonInput tendons{.tensions = {1, 0, 0.3, 0, 0.8, 0}};
  RodDynamics one(rod), other(turned);
  RodState state = one.rest(), turned_state = other.rest();
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(one.step(state, tendons, loads, 5e-3).converged());
    ASSERT_TRUE(other.step(turned_state, tendons, turned_loads, 5e-3).converged());
  }
  EXPECT_LE((turn * one.tip(state).position - other.tip(turned_state).position).norm(), 1e-9);
}

// Taut tendons keep their lengths in motion, and a tendon that is let out becomes slack.
TEST(Dynamics, TendonsThatArePulledInBendTheRod) {
  Rod rod = two_section_robot();
  for (RodSection& section : rod.sections) {
    section.density = 6000;
    section.damping_time = 3e-3;
  }
  RodDynamics dynamics(rod);
  RodState state = dynamics.rest();
  const std::vector<double> rest = dynamics.tendon_lengths(state);
  const std::vector<double> pulled = {0.004, -0.002, -0.002, 0.004, 0.002, -0.006};
  const double h = 0.01, until = 0.4;
  TendonInput tendons{.displacements = pulled};
  for (int i = 0; i < 300; ++i) {
    const double part = std::min(1.0, (i + 1) * h / until);
    for (std::size_t j = 0; j < pulled.size(); ++j) tendons.displacements[j] = part * pulled[j];
    ASSERT_TRUE(dynamics.step(state, tendons, {}, h).converged());
    for (const double tension : state.tensions) ASSERT_GE(tension, 0);
  }
  const Equilibrium at = RodStatics(rod).solve(tendons, {});
  ASSERT_TRUE(at.converged());
  EXPECT_LE((dynamics.tip(state).position - at.tip.position).norm(), 1e-7);
  for (std::size_t i = 0; i < at.tensions.size(); ++i) EXPECT_NEAR(state.tensions[i], at.tensions[i], 1e-4);
}

TEST(Dynamics, SectionsOfARodAreTheRod) {
  Rod rod = soft_tentacle();
  rod.sections[0].modes.bend = 8;
  const Eigen::Vector3d whole = tip_of_tentacle(rod, {}, 5e-3, 0.3);
  rod.sections[0].length /= 4;
  rod.sections[0].modes.bend = 4;
  rod.sections.assign(4, rod.sections[0]);
  EXPECT_LE((tip_of_tentacle(rod, {}, 5e-3, 0.3) - whole).norm(), 2e-6);
}

}  // namespace
}  // namespace flexura
