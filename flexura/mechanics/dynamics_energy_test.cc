#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

// The mechanical energy of a rod with damping that swings freely.
namespace flexura {
namespace {

// A random rod without tendons, at a random shape and random rates under its weight.
struct FreeSwing {
  FreeSwing(TestRandom& random, double rho) : rod(random_rod(random)) {
    rod.tendons.clear();
    // Half of the rods have bends only, whose fastest periods are longer.
    const bool only_bends = random.integer(0, 1) == 0;
    for (RodSection& section : rod.sections) {
      const double softer = random.uniform(0.01, 0.1);
      section.youngs_modulus *= softer;
      section.shear_modulus *= softer;
      section.modes = {.shear = only_bends ? 0 : random.integer(0, 1),
                       .stretch = only_bends ? 0 : random.integer(0, 1),
                       .bend = random.integer(1, only_bends ? 2 : 4),
                       .twist = only_bends ? 0 : random.integer(0, 1)};
      section.damping_time = std::pow(10.0, random.uniform(-4, -2));
    }
    loads.gravity = 9.81 * random.vector<3>(-1.0, 1.0).normalized();
    dynamics.emplace(rod, RodDynamicsConfig{.spectral_radius = rho});
    const Eigen::VectorXd& scales = dynamics->chain().scales();
    q.resize(scales.size());
    v.resize(scales.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const bool is_long = scales[j] == 1;  // Shear and stretch.
      q[j] = (is_long ? 1e-4 : 1) * random.uniform(-1, 1) / scales[j];
      v[j] = (is_long ? 1e-3 : 5) * random.uniform(-1, 1) / scales[j];
    }
  }
  // Returns the highest angular frequency of the undamped rod at rest, rad/s.
  [[nodiscard]] double fastest() {
    const Eigen::VectorXd none = Eigen::VectorXd::Zero(q.size());
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
        dynamics->stiffness_matrix(), dynamics->mass_matrix(none), Eigen::EigenvaluesOnly);
    return std::sqrt(eigen.eigenvalues().maxCoeff());
  }
  // Returns the most by which the energy ever exceeds an earlier value in free motion, relative to the energy
  // `scale`.
  [[nodiscard]] double rise(RodState state, double h, int steps, double scale) {
    double least = dynamics->energy(state, loads).total(), most = 0;
    for (int k = 0; k < steps; ++k) {
      EXPECT_TRUE(dynamics->step(state, {}, loads, h).converged());
      const double now = dynamics->energy(state, loads).total();
      most = std::max(most, now - least);
      least = std::min(least, now);
    }
    return most / scale;
  }
  Rod rod;
  RodLoads loads;
  std::optional<RodDynamics> dynamics;
  Eigen::VectorXd q, v;
};

// Damping takes energy at every step that resolves the fastest strain and the turning of the rod (of some
// 10 rad/s). The step's error of energy is of third order: the tolerance is 20 times the most of 150 rods.
TEST(DynamicsEnergy, NeverGrowsInStepsThatResolveTheMotion) {
  constexpr double part = 0.5, longest = 5e-4, tolerance = 1e-5;
  for_random_cases(8, [&](TestRandom& random) {
    FreeSwing swing(random, random.integer(0, 1) == 0 ? 1 : 0.8);
    const RodState state = swing.dynamics->start(swing.q, swing.v, {}, swing.loads);
    const RodEnergy begin = swing.dynamics->energy(state, swing.loads);
    const double h = std::min(longest, part / swing.fastest());
    EXPECT_LE(swing.rise(state, h, 200, begin.kinetic + begin.strain), tolerance);
  });
}

// Near an equilibrium the energy is quadratic, and the midpoint rule never lets it grow, however long the
// step is. The tolerance is for terms of third order in the motion (of 1e-3).
TEST(DynamicsEnergy, OfASmallMotionNeverGrowsByTheMidpointRule) {
  constexpr double small = 1e-3, tolerance = 1e-2;
  for_random_cases(6, [&](TestRandom& random) {
    FreeSwing swing(random, 1);
    const Equilibrium at = RodStatics(swing.rod).settle({}, swing.loads);
    if (!at.converged() || !at.stable) return;
    const RodState state = swing.dynamics->start(at.q + small * swing.q, small * swing.v, {}, swing.loads);
    const double scale = swing.dynamics->energy(state, swing.loads).total() -
                         swing.dynamics->energy(swing.dynamics->rest(at), swing.loads).total();
    for (const double h : {5e-3, 2e-2}) EXPECT_LE(swing.rise(state, h, 200, scale), tolerance);
  });
}

}  // namespace
}  // namespace flexura
