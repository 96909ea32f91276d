#include "flexura/control/distributed_arm.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include "flexura/math/dense.h"
#include "flexura/math/derivative_check.h"
#include "tests/support/distributed_arms.h"

namespace flexura {
namespace {

using std::numbers::pi;

// No drives.
double no_force(double, const DistributedArm&, const Eigen::VectorXd&, const Eigen::VectorXd&,
                Eigen::VectorXd& Q) {
  Q.setZero();
  return 0;
}

Eigen::VectorXd arc_of(const DistributedArm& arm, double bend) {
  return arm.coordinates([&](double s) { return Eigen::Vector2d(bend * s, 0); });
}

// Returns the frequencies of small motions about the current state, rad/s, increasing.
Eigen::VectorXd frequencies(const DistributedArm& arm) {
  const Cholesky mass(arm.mass_matrix());
  const Eigen::MatrixXd half = mass.solve_lower(arm.stiffness());
  return symmetric_eigen(mass.solve_lower(half.transpose())).values.cwiseMax(0).cwiseSqrt();
}

// A Newton step towards the equilibrium under generalized forces.
void go_to_rest(DistributedArm& arm, Eigen::VectorXd& x, const Eigen::VectorXd& force) {
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(x.size());
  arm.set(x, still);
  x -= Cholesky(arm.stiffness()).solve(arm.gravity_gradient() + arm.elastic_gradient() - force);
  arm.set(x, still);
}

double energy(const DistributedArm& arm) {
  return arm.kinetic_energy() + arm.gravity_energy() + arm.elastic_energy();
}

TEST(DistributedArm, HasThePlanarArcsEnergiesInClosedForm) {
  for (const AngleBasis basis : {AngleBasis::polynomial, AngleBasis::sections}) {
    DistributedArm arm({.bending_stiffness = 0.7, .basis = basis});
    const auto set = [&](double bend) { arm.set(arc_of(arm, bend), arc_of(arm, 1)); };
    for (const auto& [bend, gravity, kinetic] : std::vector<std::array<double, 3>>{
             {0.5, 4.80366, .024753}, {1, 4.509634, .024027}, {0, 4.905, .025}}) {
      set(bend);
      EXPECT_NEAR(arm.gravity_energy(), gravity, 1e-5);
      EXPECT_NEAR(arm.kinetic_energy(), kinetic, 1e-6);
      EXPECT_NEAR(arm.elastic_energy(), 0.5 * 0.7 * bend * bend, 1e-12);
      if (bend > 0) {
        EXPECT_NEAR(arm.gravity_energy(), 9.81 * (1 - std::cos(bend)) / (bend * bend), 1e-12);
        EXPECT_NEAR(arm.tip().x(), (1 - std::cos(bend)) / bend, 1e-12);
        EXPECT_NEAR(arm.tip().y(), std::sin(bend) / bend, 1e-12);
      }
    }
  }
}

TEST(DistributedArm, HasTheEnergiesOfTheIntegralsThatDefineThem) {
  for_random_cases(60, [](TestRandom& random) {
    DistributedArmModel model = random_distributed_arm(random);
    model.points = 14;
    DistributedArm arm(model);
    const Eigen::VectorXd x = random_coordinates(random, arm), v = random_rates(random, arm);
    const double dt = 1e-5;
    const auto places = [&](double t) {
      arm.set(x + t * v, v);
      return arm.positions();
    };
    const Eigen::Matrix3Xd velocity = (places(dt) - places(-dt)) / (2 * dt), position = places(0);
    const Eigen::VectorXd& w = arm.shapes().weights;
    double kinetic = 0, gravity = 0;
    for (Eigen::Index j = 0; j < w.size(); ++j) {
      kinetic += 0.5 * model.density * w[j] * velocity.col(j).squaredNorm();
      gravity -= model.density * w[j] * model.gravity.dot(position.col(j));
    }
    EXPECT_NEAR(arm.kinetic_energy(), kinetic, 1e-8 * (1 + kinetic));
    EXPECT_NEAR(arm.gravity_energy(), gravity, 1e-12);
    EXPECT_NEAR(0.5 * v.dot(arm.mass_matrix() * v), kinetic, 1e-8 * (1 + kinetic));
  });
}

TEST(DistributedArm, HasForcesThatAreTheDerivativesOfItsEnergies) {
  for_random_cases(60, [](TestRandom& random) {
    DistributedArm arm(random_distributed_arm(random));
    const Eigen::VectorXd x = random_coordinates(random, arm), still = Eigen::VectorXd::Zero(arm.size());
    const auto of_energies = numerical_jacobian(
        [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
          arm.set(at, still);
          return Eigen::Vector2d(arm.gravity_energy(), arm.elastic_energy());
        },
        x, 0.02);
    const auto of_gradient = numerical_jacobian(
        [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
          arm.set(at, still);
          return arm.gravity_gradient() + arm.elastic_gradient();
        },
        x, 0.02);
    arm.set(x, still);
    const double scale = 1 + arm.stiffness().cwiseAbs().maxCoeff();
    EXPECT_LE((of_energies.value.row(0).transpose() - arm.gravity_gradient()).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LE((of_energies.value.row(1).transpose() - arm.elastic_gradient()).cwiseAbs().maxCoeff(),
              1e-10 * scale);
    EXPECT_LE((of_gradient.value - arm.stiffness()).cwiseAbs().maxCoeff(), 1e-9 * scale);
  });
}

TEST(DistributedArm, ObeysLagrangesEquations) {
  // d/dt(dT/dv) - dT/dx + dV/dx = Q - damping, with the derivatives of the mass matrix by differences.
  for_random_cases(40, [](TestRandom& random) {
    DistributedArmModel model = random_distributed_arm(random);
    model.damping = random.uniform(0, 0.3), model.length_damping = random.uniform(0, 2);
    DistributedArm arm(model);
    const Eigen::VectorXd x = random_coordinates(random, arm), v = random_rates(random, arm),
                          Q = random_rates(random, arm);
    const auto momentum = numerical_jacobian(
        [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
          arm.set(at, v);
          return arm.mass_matrix() * v;
        },
        x, 0.02);
    arm.set(x, v);
    Eigen::VectorXd a(arm.size());
    ASSERT_TRUE(arm.accelerate(Q, a));
    double power = 0;
    const Eigen::Index n = arm.nodes();
    const Eigen::VectorXd theta_t = arm.shapes().values * v.head(n),
                          q_t = arm.shapes().values * v.segment(n, n);
    for (Eigen::Index j = 0; j < theta_t.size(); ++j) {
      const double across = std::cos(arm.q()[j]) * theta_t[j];
      power += model.damping * arm.shapes().weights[j] * (across * across + q_t[j] * q_t[j]);
    }
    power += model.length_damping * v.tail(arm.size() - 2 * n).squaredNorm();
    EXPECT_NEAR(arm.damping_power(), power, 1e-12 * (1 + power));
    const Eigen::VectorXd rest = arm.mass_matrix() * a + momentum.value * v -
                                 0.5 * momentum.value.transpose() * v + arm.gravity_gradient() +
                                 arm.elastic_gradient() - Q;
    // The rest is the damping's force: its power is the dissipation.
    EXPECT_NEAR(-v.dot(rest), power, 1e-8 * (1 + power));
    if (model.damping == 0) {
      EXPECT_LE(rest.cwiseAbs().maxCoeff(), 1e-8);
    }
    DistributedArmModel bare = model;
    bare.damping = bare.length_damping = 0;
    DistributedArm free_arm(bare);
    free_arm.set(x, v);
    ASSERT_TRUE(free_arm.accelerate(Q, a));
    const Eigen::VectorXd nothing = free_arm.mass_matrix() * a + momentum.value * v -
                                    0.5 * momentum.value.transpose() * v + free_arm.gravity_gradient() +
                                    free_arm.elastic_gradient() - Q;
    EXPECT_LE(nothing.cwiseAbs().maxCoeff(), 1e-8);
  });
}

TEST(DistributedArm, HangsAsAChainInTheModesOfBesselsFunction) {
  // Zeros of J_0; the chain hangs along +Y.
  const DistributedArm chain({.gravity = {0, 9.81, 0}, .clamp = std::nullopt, .nodes = 12});
  const Eigen::VectorXd found = frequencies(chain);
  const double unit = 0.5 * std::sqrt(9.81);
  for (const int angle : {0, 1}) {
    EXPECT_NEAR(found[angle], 2.404825557695773 * unit, 1e-7);
    EXPECT_NEAR(found[2 + angle], 5.520078110286311 * unit, 1e-6);
    EXPECT_NEAR(found[4 + angle], 8.653727912911013 * unit, 1e-5);
  }
}

TEST(DistributedArm, VibratesAsAClampedBeam) {
  // cos b cosh b = -1; and a steel rod of 1 mm radius, 0.5 m long, in Hz.
  DistributedArmModel rod{.lengths = {0.5},
                          .density = 8000 * pi * 1e-6,
                          .gravity = {0, 0, 0},
                          .bending_stiffness = 200e9 * pi * 1e-12 / 4,
                          .nodes = 12};
  const DistributedArm arm(rod);
  const Eigen::VectorXd found = frequencies(arm) / (2 * pi);
  const std::array<double, 4> expected = {5.595912, 35.068983, 98.194166, 192.421376};
  for (std::size_t mode = 0; mode < expected.size(); ++mode)
    EXPECT_NEAR(found[static_cast<Eigen::Index>(2 * mode)], expected[mode], 2e-6 * expected[mode]);
  // Arms bent section by section converge with the square of the sections' length.
  const auto error = [&](int sections) {
    rod.basis = AngleBasis::sections, rod.points = 4;
    rod.lengths.assign(static_cast<std::size_t>(sections), 0.5 / sections);
    return std::abs(frequencies(DistributedArm(rod))[0] / (2 * pi) - expected[0]);
  };
  EXPECT_NEAR(error(6) / error(12), 4, 0.3);
}

TEST(DistributedArm, BucklesUnderItsWeightWhereGreenhillsColumnDoes) {
  // rho g L^3/EI = 9/4 j^2, j the first zero of J_(-1/3).
  const auto stiffest = [](double load) {
    const DistributedArm arm({.gravity = {0, -load, 0}, .bending_stiffness = 1});
    return least_eigenvalue(arm.stiffness());
  };
  EXPECT_GT(stiffest(7.8373 - 1e-3), 0);
  EXPECT_LT(stiffest(7.8373 + 1e-3), 0);
}

TEST(DistributedArm, RestsAsACantileverUnderItsWeight) {
  for (const auto& [load, drop] :
       std::vector<std::array<double, 2>>{{1, .12347}, {10, .70020}, {50, .90792}}) {
    Eigen::VectorXd x;
    DistributedArm arm({});
    // Loaded gradually from straight.
    for (int share = 1; share <= 10; ++share) {
      arm = DistributedArm(
          {.gravity = {0.1 * share * load, 0, 0}, .bending_stiffness = 1, .nodes = 18, .points = 24});
      if (share == 1) x = Eigen::VectorXd::Zero(arm.size());
      for (int i = 0; i < 10; ++i) go_to_rest(arm, x, Eigen::VectorXd::Zero(arm.size()));
    }
    EXPECT_NEAR(arm.tip().x(), drop, 1e-5);
    EXPECT_NEAR(arm.tip().z(), 0, 1e-12);
  }
}

TEST(DistributedArm, SwingsAsASolverOfAnotherKindHasIt) {
  // A steel rod held level, bent by 20 g at its tip and released. The tip's height is compared with an
  // independent rod solver, to 5e-5 m. The solver uses the total wrench of the rod for the start, a spectral
  // model in strains, and DOP853.
  DistributedArm arm({.lengths = {0.5},
                      .density = 8000 * pi * 1e-6,
                      .gravity = {-9.81, 0, 0},
                      .bending_stiffness = 200e9 * pi * 1e-12 / 4,
                      .nodes = 6});
  Eigen::VectorXd x = Eigen::VectorXd::Zero(arm.size());
  for (int i = 0; i < 60; ++i) {
    const auto of_tip = numerical_jacobian(
        [&](const Eigen::VectorXd& at) -> Eigen::VectorXd {
          arm.set(at, Eigen::VectorXd::Zero(arm.size()));
          return arm.tip();
        },
        x, 0.02);
    go_to_rest(arm, x, of_tip.value.transpose() * Eigen::Vector3d(-0.02 * 9.81, 0, 0));
  }
  DistributedMotion motion(arm, no_force, {.relative = 1e-8, .absolute = 1e-10, .first_step = 1e-5});
  motion.start(x);
  for (const auto& [time, height] :
       std::vector<std::array<double, 2>>{{0, -.06330}, {0.05, -.00301}, {0.1, .03526}, {0.25, .02807}}) {
    ASSERT_TRUE(motion.advance(time));
    EXPECT_NEAR(motion.arm().tip().x(), height, 1e-4) << "at " << time << " s";
  }
}

TEST(DistributedArm, KeepsItsEnergy) {
  double most = 0;
  for_random_cases(6, [&most](TestRandom& random) {
    DistributedArmModel model = random_distributed_arm(random);
    model.bending_stiffness *= 0.2;
    const DistributedArm arm(model);
    DistributedMotion motion(arm, no_force, {.relative = 1e-10, .absolute = 1e-12});
    motion.start(random_coordinates(random, arm, 0.5));
    const double start = energy(motion.arm());
    double least = motion.arm().gravity_energy() + motion.arm().elastic_energy(), top = least, moved = 0;
    for (int i = 1; i <= 20; ++i) {
      if (!motion.advance(0.05 * i)) break;  // At |q| = 90 degrees the coordinates are singular.
      EXPECT_NEAR(energy(motion.arm()), start, 1e-7 * (1 + std::abs(start)));
      most = std::max(most, std::abs(energy(motion.arm()) - start));
      const double potential = motion.arm().gravity_energy() + motion.arm().elastic_energy();
      least = std::min(least, potential), top = std::max(top, potential);
      moved = motion.time();
    }
    EXPECT_GT(moved, 0.04);
    EXPECT_GT(top - least, 1e-3);  // Energy was indeed exchanged.
  });
  std::printf("largest drift of the energy over a second: %.1e J\n", most);
  DistributedArm chain({.gravity = {0, 9.81, 0}, .clamp = std::nullopt, .nodes = 6, .points = 8});
  DistributedMotion swing(chain, no_force, {.relative = 1e-11, .absolute = 1e-13});
  swing.start(chain.coordinates([](double s) { return Eigen::Vector2d(0.7, 0.4 * s); }));
  const double before = energy(swing.arm());
  ASSERT_TRUE(swing.advance(5));
  EXPECT_NEAR(energy(swing.arm()), before, 1e-8);
  std::printf("a hanging chain over 5 s: %.1e J of %.3f\n", energy(swing.arm()) - before, before);
}

TEST(DistributedArm, LosesWhatDampingTakes) {
  for_random_cases(6, [](TestRandom& random) {
    DistributedArmModel model = random_distributed_arm(random);
    model.damping = 0.4, model.length_damping = 3, model.bending_stiffness *= 0.2;
    const DistributedArm arm(model);
    DistributedMotion motion(arm, no_force, {.relative = 1e-9, .absolute = 1e-11});
    motion.start(random_coordinates(random, arm, 0.5));
    const double start = energy(motion.arm());
    ASSERT_TRUE(motion.advance(0.3));
    const double taken = motion.damped();
    EXPECT_GT(taken, 1e-4);
    EXPECT_NEAR(energy(motion.arm()), start - taken, 1e-6 * (1 + std::abs(start)));
  });
}

TEST(DistributedArm, ConvergesWithAHighOrderOfItsNodes) {
  // Pushed along its whole length, smoothly at first: released from an arbitrary shape, it would oscillate in
  // all modes.
  const auto push = [](double t, const DistributedArm& arm, const Eigen::VectorXd&, const Eigen::VectorXd&,
                       Eigen::VectorXd& Q) {
    const double wave = std::sin(pi * t), torque = 4 * wave * wave * wave * wave;
    const Eigen::VectorXd along = arm.shapes().values.transpose() * arm.shapes().weights;
    Q << torque * along, 0.5 * torque * along;
    return 0.0;
  };
  const auto tip = [&](int nodes) {
    const DistributedArm arm({.gravity = {0, -3, 0}, .bending_stiffness = 0.5, .nodes = nodes, .points = 10});
    DistributedMotion motion(arm, push, {.relative = 1e-10, .absolute = 1e-12});
    motion.start(Eigen::VectorXd::Zero(arm.size()));
    EXPECT_TRUE(motion.advance(0.7));
    return motion.arm().tip();
  };
  const Eigen::Vector3d exact = tip(8);
  double before = (tip(2) - exact).norm();
  for (const int nodes : {3, 4, 5, 6}) {
    const double now = (tip(nodes) - exact).norm();
    std::printf("%d nodes: tip off by %.1e m\n", nodes, now);
    EXPECT_LT(now, 0.4 * before);
    before = now;
  }
  // From three nodes to twice as many: the sixth order or more.
  EXPECT_LT(before * 64, (tip(3) - exact).norm());
}

TEST(DistributedArm, RefusesWhatIsNoArm) {
  EXPECT_THROW(DistributedArm({.lengths = {}}), std::invalid_argument);
  EXPECT_THROW(DistributedArm({.lengths = {1, -1}}), std::invalid_argument);
  EXPECT_THROW(DistributedArm({.density = 0}), std::invalid_argument);
  EXPECT_THROW(DistributedArm({.bending_stiffness = -1}), std::invalid_argument);
  EXPECT_THROW(DistributedArm({.damping = std::numeric_limits<double>::quiet_NaN()}), std::invalid_argument);
  EXPECT_THROW(DistributedArm({.clamp = std::array<double, 2>{0, 1.6}}), std::invalid_argument);
  EXPECT_THROW(DistributedArm({.nodes = 9, .points = 8}), std::invalid_argument);
  DistributedArm arm({});
  EXPECT_THROW(arm.set(Eigen::VectorXd::Zero(3), Eigen::VectorXd::Zero(3)), std::invalid_argument);
  // If q is 90 degrees everywhere, theta is not a coordinate.
  DistributedArm upright({.clamp = std::nullopt, .nodes = 2});
  upright.set(upright.coordinates([](double) { return Eigen::Vector2d(0, pi / 2); }),
              Eigen::VectorXd::Zero(4));
  Eigen::VectorXd a = Eigen::VectorXd::Zero(4);
  const Eigen::VectorXd push = Eigen::VectorXd::Ones(4);
  EXPECT_TRUE(!upright.accelerate(push, a) || a.cwiseAbs().maxCoeff() > 1e12);
}

}  // namespace
}  // namespace flexura
