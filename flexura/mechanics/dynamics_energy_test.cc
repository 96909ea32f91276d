#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
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
  [[nodiscard]] double rise(RodState state, double h, int steps, double scale, int* pieces = nullptr) {
    double least = dynamics->energy(state, loads).total(), most = 0;
    for (int k = 0; k < steps; ++k) {
      const RodStep step = dynamics->step(state, {}, loads, h);
      EXPECT_TRUE(step.converged());
      if (pieces != nullptr) *pieces += step.pieces > 1 ? 1 : 0;
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

TEST(DynamicsEnergy, Measure) {
  for (const double rho : {1.0, 0.8, 0.1})
    for (const double part : {0.25, 0.5, 1.0, 2.0, 4.0, 16.0}) {
      double worst = 0;
      int pieces = 0, rods = 0, steps = 0;
      for (int i = 0; i < 20; ++i) {
        TestRandom random(case_seed(i));
        FreeSwing swing(random, rho);
        const RodState state = swing.dynamics->start(swing.q, swing.v, {}, swing.loads);
        const RodEnergy begin = swing.dynamics->energy(state, swing.loads);
        const double most =
            swing.rise(state, part / swing.fastest(), 200, begin.kinetic + begin.strain, &pieces);
        worst = std::max(worst, most);
        rods += most > 1e-9;
      }
      std::printf("rho %g h omega %g: rise %.2e, rods %d of 20, pieces %d\n", rho, part, worst, rods, pieces);
      std::fflush(stdout);
    }
}

TEST(DynamicsEnergy, MeasureLinear) {
  for (const double rho : {1.0, 0.8, 0.1})
    for (const double h : {1e-3, 5e-3, 2e-2})
      for (const double small : {1e-3, 1e-4}) {
        double worst = 0;
        int pieces = 0, rods = 0;
        for (int i = 0; i < 12; ++i) {
          TestRandom random(case_seed(i));
          FreeSwing swing(random, rho);
          const Equilibrium at = RodStatics(swing.rod).settle({}, swing.loads);
          if (!at.converged() || !at.stable) continue;
          const RodState state =
              swing.dynamics->start(at.q + small * swing.q, small * swing.v, {}, swing.loads);
          const double scale = swing.dynamics->energy(state, swing.loads).total() -
                               swing.dynamics->energy(swing.dynamics->rest(at), swing.loads).total();
          const double most = swing.rise(state, h, 200, scale, &pieces);
          worst = std::max(worst, most);
          rods += most > 1e-9;
        }
        std::printf("rho %g h %g small %g: rise %.2e rods %d pieces %d\n", rho, h, small, worst, rods,
                    pieces);
        std::fflush(stdout);
      }
}

}  // namespace
}  // namespace flexura
