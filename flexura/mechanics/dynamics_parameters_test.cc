#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "flexura/math/derivative_check.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_contact.h"
#include "flexura/mechanics/rod_drag.h"
#include "flexura/mechanics/surroundings.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

// Tests of the derivatives of motions and steps by the parameters of the rod's sections.
namespace flexura {
namespace {

// A random soft rod in motion. Stiffness, mass and damping are given directly, so that each can be changed.
struct SoftMoving {
  explicit SoftMoving(TestRandom& random, double friction = 0) : rod(random_rod(random, friction)) {
    const bool has_disks = random.integer(0, 2) == 0;
    for (RodSection& section : rod.sections) {
      section.modes = {.shear = random.integer(0, 1),
                       .stretch = random.integer(1, 2),
                       .bend = random.integer(1, 4),
                       .twist = random.integer(1, 2)};
      section.stiffness = section.stiffness_at(0.5);
      section.stiffness->head<3>() *= 1e-3;  // Steps of some ms resolve shear and stretch.
      section.mass_per_length = section.mass_per_length_at(0.5);
      section.damping = random.uniform(1e-3, 2e-2) * *section.stiffness;
      if (has_disks) section.disks = 3;
    }
    for (TendonRoute& tendon : rod.tendons) tendon.compliance = random.uniform(1e-4, 1e-3);
    loads.gravity = random.vector<3>(-10.0, 10.0);
    loads.per_length = random.vector<3>(-0.1, 0.1);
    if (random.integer(0, 1) == 0) {
      for (std::size_t i = 0; i < rod.tendons.size(); ++i) input.tensions.push_back(random.uniform(0.1, 1.5));
    } else {
      for (std::size_t i = 0; i < rod.tendons.size(); ++i)
        input.displacements.push_back(random.uniform(1e-3, 5e-3));
    }
    const RodChain chain(rod);
    q.resize(chain.size());
    v.resize(chain.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const bool is_long = chain.scales()[j] == 1;  // Shear and stretch.
      q[j] = (is_long ? 0.01 : 0.4) * random.uniform(-1, 1) / chain.scales()[j];
      v[j] = (is_long ? 0.05 : 2) * random.uniform(-1, 1) / chain.scales()[j];
    }
  }
  // Returns the rod with a parameter (an index among all sections' parameters) times a factor.
  [[nodiscard]] Rod with(Eigen::Index parameter, double factor) const {
    Rod other = rod;
    RodSection& section = other.sections[static_cast<std::size_t>(parameter / dynamics_parameters)];
    switch (parameter % dynamics_parameters) {
      case 0:
        section.stiffness->head<2>() *= factor;
        break;
      case 1:
        (*section.stiffness)[2] *= factor;
        break;
      case 2:
        section.stiffness->segment<2>(3) *= factor;
        break;
      case 3:
        (*section.stiffness)[5] *= factor;
        break;
      case 4:
        *section.mass_per_length *= factor;
        break;
      default:
        *section.damping *= factor;
    }
    return other;
  }
  [[nodiscard]] Eigen::Index parameters() const {
    return dynamics_parameters * static_cast<Eigen::Index>(rod.sections.size());
  }
  Rod rod;
  RodLoads loads;
  TendonInput input;
  Eigen::VectorXd q, v;
};

// Water, and a ball that covers the outer part of the rod, with friction.
struct WetAndTouching {
  WetAndTouching(const RodDynamics& dynamics, const Eigen::Vector3d& tip)
      : drag(dynamics.chain(), {.density = 1000, .flow = {0.1, -0.2, 0.05}}),
        contact(dynamics.chain(),
                {.law = {.stiffness = 1e3, .friction = 0.4, .slip_speed = 0.1, .transition = 0.01},
                 .obstacles = {SphereConfig{.center = {tip.x(), tip.y(), tip.z()}, .radius = 0.03}},
                 .itself = false}),
        all(std::vector<const RodSurroundings*>{&drag, &contact}) {}
  RodDrag drag;
  RodContact contact;
  Surroundings all;
};

// A rod with a parameter changed, and its surroundings. Its steps are not repeated with another spectral
// radius, which would have other derivatives.
struct ChangedRod {
  ChangedRod(const SoftMoving& moving, Eigen::Index parameter, double factor, const Eigen::Vector3d* ball)
      : dynamics(moving.with(parameter, factor),
                 {.tolerance = 1e-11, .most_iterations = 200, .most_pieces = 1}) {
    if (ball == nullptr) return;
    surroundings = std::make_unique<WetAndTouching>(dynamics, *ball);
    dynamics.set_surroundings(&surroundings->all);
  }
  RodDynamics dynamics;
  std::unique_ptr<WetAndTouching> surroundings;
};

// First relative change of a parameter for differences. Larger ones more often meet kinks: tendons that
// become slack, contacts that begin.
constexpr double first_step = 5e-4;

// Expects each block of n rows of a column to be that by differences, relative to the block's largest number.
// `sizes`: those of the differentiated function itself by block. Rounding of 1e-16 of them, amplified by the
// stiffest modes, divided by the step of the differences, is allowed.
void expect_column(const Eigen::VectorXd& found, const NumericalJacobian& known,
                   const Eigen::VectorXd& values, Eigen::Index n) {
  for (Eigen::Index block = 0; block < found.size(); block += n) {
    const double size = known.value.col(0).segment(block, n).cwiseAbs().maxCoeff();
    const double rounding = 1e-8 * values.segment(block, n).cwiseAbs().maxCoeff();
    EXPECT_LE((found - known.value.col(0)).segment(block, n).cwiseAbs().maxCoeff(), 1e-5 * size + rounding)
        << "block " << block / n << ", size " << size;
  }
}

void expect_step_by_parameters(TestRandom& random, double friction) {
  const SoftMoving moving(random, friction);
  const bool touches = random.integer(0, 1) == 0;
  const double h = random.uniform(1e-3, 4e-3);
  RodDynamics plain(moving.rod);
  const Eigen::Vector3d tip = plain.tip(plain.start(moving.q, moving.v, moving.input, moving.loads)).position;
  ChangedRod given(moving, 0, 1, touches ? &tip : nullptr);
  const RodState state = given.dynamics.start(moving.q, moving.v, moving.input, moving.loads);
  // With friction not every step has a solution that Newton's method finds to this tolerance.
  RodState once = state;
  if (!given.dynamics.step(once, moving.input, moving.loads, h).converged()) return;
  const RodStepSlopes slopes = given.dynamics.step_slopes(state, moving.input, moving.loads, h);
  const Eigen::Index n = state.q.size();
  ASSERT_EQ(slopes.by_parameters.rows(), 4 * n);
  ASSERT_EQ(slopes.by_parameters.cols(), moving.parameters());
  const auto stepped = [&](RodDynamics& dynamics) {
    RodState one = state;
    EXPECT_TRUE(dynamics.step(one, moving.input, moving.loads, h).converged());
    return Eigen::VectorXd((Eigen::VectorXd(4 * n) << one.q, one.momentum, one.rate, one.force).finished());
  };
  const Eigen::VectorXd values = stepped(given.dynamics);
  for (Eigen::Index parameter = 0; parameter < moving.parameters(); ++parameter) {
    SCOPED_TRACE("parameter " + std::to_string(parameter));
    const NumericalJacobian known = numerical_jacobian(
        [&](const Eigen::VectorXd& x) {
          ChangedRod other(moving, parameter, 1 + x[0], touches ? &tip : nullptr);
          return stepped(other.dynamics);
        },
        Eigen::VectorXd::Zero(1), first_step);
    expect_column(slopes.by_parameters.col(parameter), known, values, n);
  }
}

TEST(DynamicsParameters, DerivativesOfMomentaAndForcesAreThoseByDifferences) {
  for_random_cases(6, [](TestRandom& random) {
    const SoftMoving moving(random, random.integer(0, 1) == 0 ? 0.3 : 0);
    RodDynamics dynamics(moving.rod);
    const RodState state = dynamics.start(moving.q, moving.v, moving.input, moving.loads);
    const RodDynamicsSlopes slopes = dynamics.slopes(state, moving.input, moving.loads);
    const Eigen::Index n = state.q.size();
    Eigen::VectorXd values(2 * n);
    values << state.momentum, state.force;
    for (Eigen::Index parameter = 0; parameter < moving.parameters(); ++parameter) {
      SCOPED_TRACE("parameter " + std::to_string(parameter));
      const NumericalJacobian known = numerical_jacobian(
          [&](const Eigen::VectorXd& x) {
            RodDynamics other(moving.with(parameter, 1 + x[0]));
            const RodState there = other.start(moving.q, moving.v, moving.input, moving.loads);
            return Eigen::VectorXd((Eigen::VectorXd(2 * n) << there.momentum, there.force).finished());
          },
          Eigen::VectorXd::Zero(1), first_step);
      Eigen::VectorXd found(2 * n);
      found << slopes.momentum_by_parameters.col(parameter), slopes.force_by_parameters.col(parameter);
      expect_column(found, known, values, n);
    }
  });
}

TEST(DynamicsParameters, DerivativesOfAStepAreThoseByDifferences) {
  for_random_cases(6, [](TestRandom& random) { expect_step_by_parameters(random, 0); });
}

TEST(DynamicsParameters, DerivativesOfAStepWithFrictionAreThoseByDifferences) {
  for_random_cases(4, [](TestRandom& random) { expect_step_by_parameters(random, 0.3); });
}

// The linear model's rest moves with the parameters as the equilibrium of the statics does.
TEST(DynamicsParameters, MoveTheRestOfTheLinearModelLikeTheEquilibrium) {
  for_random_cases(6, [](TestRandom& random) {
    const SoftMoving moving(random);
    RodStatics statics(moving.rod);
    const TendonInput input{.tensions = random_tensions(random, moving.rod, 1)};
    const Equilibrium at = statics.solve(input, moving.loads);
    if (!at.converged() || !at.stable) return;
    const Eigen::MatrixXd known = statics.slopes().q_by_parameters;
    RodDynamics dynamics(moving.rod);
    const RodLinear linear = dynamics.linearize(dynamics.rest(at), input, moving.loads);
    const Eigen::Index n = at.q.size();
    const Eigen::MatrixXd rest = -linear.A_rest.partialPivLu().solve(linear.by_parameters_rest),
                          also = -linear.A.partialPivLu().solve(linear.by_parameters);
    for (std::size_t i = 0; i < moving.rod.sections.size(); ++i) {
      for (Eigen::Index j = 0; j < dynamics_parameters; ++j) {
        const Eigen::Index column = static_cast<Eigen::Index>(i) * dynamics_parameters + j;
        const Eigen::VectorXd scaled = dynamics.chain().scales();
        const Eigen::VectorXd expected =
            j < 5 ? Eigen::VectorXd(known.col(5 * static_cast<Eigen::Index>(i) + j))
                  : Eigen::VectorXd::Zero(n);
        for (const Eigen::MatrixXd* found : {&rest, &also})
          EXPECT_LE((found->col(column).head(n) - expected).cwiseProduct(scaled).cwiseAbs().maxCoeff(),
                    1e-6 * (1e-2 + expected.cwiseProduct(scaled).cwiseAbs().maxCoeff()))
              << column;
      }
    }
  });
}

// The same for tendons that are held at their lengths and hardly stretch. A would have errors up to a
// hundredth.
TEST(DynamicsParameters, MoveTheRestOfHeldTendonsLikeTheEquilibrium) {
  int held = 0;
  for_random_cases(8, [&](TestRandom& random) {
    SoftMoving moving(random);
    for (TendonRoute& tendon : moving.rod.tendons) tendon.compliance = 0;
    RodStatics statics(moving.rod);
    const TendonInput pulls{.tensions = std::vector<double>(moving.rod.tendons.size(), 1)};
    const Equilibrium pulled = statics.solve(pulls, moving.loads);
    if (!pulled.converged() || !pulled.stable) return;
    const TendonInput input{.displacements = pulled.displacements};
    const Equilibrium at = statics.solve(input, moving.loads, pulled);
    ASSERT_TRUE(at.converged());
    ++held;
    RodDynamics dynamics(moving.rod);
    const RodLinear linear = dynamics.linearize(dynamics.rest(at), input, moving.loads);
    const Eigen::Index n = at.q.size();
    const Eigen::MatrixXd rest =
        -linear.slopes.force_by_q.partialPivLu().solve(linear.slopes.force_by_parameters);
    const Eigen::VectorXd scales = dynamics.chain().scales();
    for (Eigen::Index parameter = 0; parameter < moving.parameters(); ++parameter) {
      if (parameter % dynamics_parameters == dynamics_parameters - 1) continue;  // Damping.
      const auto q_with = [&](double change) {
        const Equilibrium there =
            RodStatics(moving.with(parameter, 1 + change)).solve(input, moving.loads, at);
        EXPECT_TRUE(there.converged());
        return there.q;
      };
      const auto difference = [&](double h) { return Eigen::VectorXd((q_with(h) - q_with(-h)) / (2 * h)); };
      const Eigen::VectorXd known = (4 * difference(1e-3) - difference(2e-3)) / 3;
      EXPECT_LE((rest.col(parameter).head(n) - known).cwiseProduct(scales).cwiseAbs().maxCoeff(),
                1e-6 * (1e-2 + known.cwiseProduct(scales).cwiseAbs().maxCoeff()))
          << parameter;
    }
  });
  EXPECT_GT(held, 0);
}

}  // namespace
}  // namespace flexura
