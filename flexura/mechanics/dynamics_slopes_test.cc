#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "flexura/math/derivative_check.h"
#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/rod_layout.h"
#include "flexura/mechanics/rod_motion.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

namespace flexura {
namespace {

// A rod in motion with all kinds of sections, tendons and loads.
struct Moving {
  explicit Moving(TestRandom& random) : rod(random_rod(random)) {
    const bool has_disks = random.integer(0, 2) == 0;
    for (RodSection& section : rod.sections) {
      section.modes = {.shear = 1, .stretch = 2, .bend = 3, .twist = 2};
      section.damping_time = random.uniform(0, 0.01);
      if (has_disks) section.disks = 3;
    }
    loads = random_loads(random, rod);
    tendons.tensions = random_tensions(random, rod, 5);
    const RodChain chain(rod);
    q.resize(chain.size());
    v.resize(chain.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const bool is_long = chain.scales()[j] == 1;  // Shear and stretch.
      q[j] = (is_long ? 0.02 : 1) * random.uniform(-1, 1) / chain.scales()[j];
      v[j] = (is_long ? 0.02 : 1) * random.uniform(-5, 5) / chain.scales()[j];
    }
  }
  Rod rod;
  RodLoads loads;
  TendonInput tendons;
  Eigen::VectorXd q, v;
};

void expect_same(const Eigen::MatrixXd& found, const Eigen::MatrixXd& known, double part) {
  EXPECT_LE((found - known).cwiseAbs().maxCoeff(), part * known.cwiseAbs().maxCoeff());
}

// Springs to the undeformed shape, and viscous drag: forces at nodes that depend on poses and velocities.
class Honey : public RodSurroundings {
 public:
  void pull(std::span<const NodeMotion> nodes, std::span<const double> run,
            std::span<NodePull> pulls) const override {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const Eigen::Vector3d p = nodes[k].pose.position;
      const Eigen::Vector3d u = nodes[k].twist.head<3>() + nodes[k].twist.tail<3>().cross(p);
      const Eigen::Vector3d force = run[k] * (-drag * u.norm() * u - spring * p);
      // Derivatives of position p and velocity u: dp = [1, -p x] twist, du = [1, -p x] change + w x dp.
      Eigen::Matrix<double, 3, 6> moves;
      moves << Eigen::Matrix3d::Identity(), -cross(p);
      const Eigen::Matrix3d by_u = -run[k] * drag *
                                   (u.norm() * Eigen::Matrix3d::Identity() + u * u.normalized().transpose()),
                            by_p = -run[k] * spring * Eigen::Matrix3d::Identity() +
                                   by_u * cross(nodes[k].twist.tail<3>());
      pulls[k].wrench << force, p.cross(force);
      const auto as_wrench = [&](const Eigen::Matrix<double, 3, 6>& by) {
        Matrix6d result;
        result << by, cross(p) * by;
        return result;
      };
      pulls[k].by_twist = as_wrench(by_u * moves);
      pulls[k].by_pose = as_wrench(by_p * moves);
      pulls[k].by_pose.bottomRows<3>() -= cross(force) * moves;
    }
  }

 private:
  static Eigen::Matrix3d cross(const Eigen::Vector3d& a) {
    Eigen::Matrix3d m;
    m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    return m;
  }
  static constexpr double drag = 0.3, spring = 2;
};

// Lagrange's equations: dT/dv = p, dT/dq appears in the forces, and T = p . v / 2.
TEST(DynamicsSlopes, MomentaAndForcesAreThoseOfTheKineticEnergy) {
  for_random_cases(10, [](TestRandom& random) {
    const Moving moving(random);
    const RodChain chain(moving.rod);
    const RodLayout layout(chain, true);
    RodMotion<double> motion(layout);
    const std::vector<double> none(chain.tendons());
    Eigen::VectorXd momentum(moving.q.size()), force(moving.q.size());
    const auto balance = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
      motion.place(q.data(), v.data());
      motion.pull({}, none.data(), nullptr);
      motion.balance(momentum.data(), force.data());
    };
    const auto kinetic = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
      balance(q, v);
      double sum = 0;
      for (std::size_t k = 0; k < layout.nodes; ++k) {
        const Screw<double>&P = motion.momenta()[k], &V = motion.velocities()[k];
        sum += 0.5 * (dot(P.linear, V.linear) + dot(P.angular, V.angular));
      }
      return Eigen::VectorXd::Constant(1, sum);
    };
    const auto by_q =
        numerical_jacobian([&](const Eigen::VectorXd& q) { return kinetic(q, moving.v); }, moving.q);
    const auto by_v =
        numerical_jacobian([&](const Eigen::VectorXd& v) { return kinetic(moving.q, v); }, moving.v);
    const double energy = kinetic(moving.q, moving.v)[0];
    Eigen::VectorXd inner(moving.q.size());
    for (const RodLayout::Section& section : layout.sections) {
      const auto first = static_cast<Eigen::Index>(section.first_mode),
                 size = static_cast<Eigen::Index>(section.modes);
      inner.segment(first, size) = -section.stiffness * moving.q.segment(first, size) -
                                   section.damping * moving.v.segment(first, size);
    }
    balance(moving.q, moving.v);
    EXPECT_NEAR(0.5 * momentum.dot(moving.v), energy, 1e-12 * energy);
    expect_same(momentum.transpose(), by_v.value, 1e-8);
    // The stiffness forces are far greater.
    EXPECT_LE((force - inner - by_q.value.transpose()).cwiseAbs().maxCoeff(),
              1e-8 * by_q.value.cwiseAbs().maxCoeff() + 1e-13 * inner.cwiseAbs().maxCoeff());
  });
}

TEST(DynamicsSlopes, TheMassMatrixIsSymmetricAndPositive) {
  for_random_cases(10, [](TestRandom& random) {
    const Moving moving(random);
    RodDynamics dynamics(moving.rod);
    const Eigen::MatrixXd mass = dynamics.mass_matrix(moving.q);
    const RodState state = dynamics.start(moving.q, moving.v, {}, {});
    expect_same(mass * moving.v, state.momentum, 1e-12);
    expect_same(mass, mass.transpose(), 1e-14);
    const Eigen::VectorXd scales = dynamics.chain().scales().cwiseInverse();
    const Eigen::VectorXd eigenvalues = Eigen::MatrixXd(scales.asDiagonal() * mass * scales.asDiagonal())
                                            .selfadjointView<Eigen::Lower>()
                                            .eigenvalues();
    EXPECT_GT(eigenvalues.minCoeff(), 0);
    // Short pieces have light modes: rates are as exact as the matrix is well conditioned.
    const Eigen::VectorXd v = dynamics.velocity(state);
    expect_same(mass * v, state.momentum, 1e-13);
    const double condition = eigenvalues.maxCoeff() / eigenvalues.minCoeff();
    expect_same(v, moving.v, 1e-12 + 1e-16 * condition);
    EXPECT_NEAR(dynamics.energy(state, {}).kinetic, 0.5 * moving.v.dot(mass * moving.v),
                1e-8 * moving.v.dot(mass * moving.v));
  });
}

// Newton-Euler accelerations satisfy Lagrange's M a = f - (dp/dq) v.
TEST(DynamicsSlopes, AccelerationsAreThoseOfLagrangesEquations) {
  const Honey honey;
  for_random_cases(10, [&](TestRandom& random) {
    const Moving moving(random);
    RodDynamics dynamics(moving.rod);
    dynamics.set_surroundings(&honey);
    const RodState state = dynamics.start(moving.q, moving.v, moving.tendons, moving.loads);
    const RodDynamicsSlopes slopes = dynamics.slopes(state, moving.tendons, moving.loads);
    const Eigen::VectorXd a = dynamics.acceleration(moving.q, moving.v, moving.tendons, moving.loads);
    expect_same(slopes.mass * a, state.force - slopes.momentum_by_q * moving.v, 1e-9);
  });
}

TEST(DynamicsSlopes, AreThoseByDifferences) {
  const Honey honey;
  for_random_cases(8, [&](TestRandom& random) {
    Moving moving(random);
    for (TendonRoute& tendon : moving.rod.tendons) tendon.compliance = 1e-3;
    RodDynamics dynamics(moving.rod);
    if (random.integer(0, 1) == 0) dynamics.set_surroundings(&honey);
    if (random.integer(0, 1) == 0)
      moving.tendons = {.displacements = std::vector<double>(moving.rod.tendons.size(), 0.02)};
    const RodState state = dynamics.start(moving.q, moving.v, moving.tendons, moving.loads);
    const RodDynamicsSlopes slopes = dynamics.slopes(state, moving.tendons, moving.loads);
    const auto at = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
      return dynamics.start(q, v, moving.tendons, moving.loads);
    };
    const auto check = [](const VectorFunction& f, const Eigen::VectorXd& x, const Eigen::MatrixXd& known) {
      expect_same(numerical_jacobian(f, x, 1e-2).value, known, 1e-7);
    };
    check([&](const Eigen::VectorXd& q) { return at(q, moving.v).momentum; }, moving.q, slopes.momentum_by_q);
    check([&](const Eigen::VectorXd& q) { return at(q, moving.v).force; }, moving.q, slopes.force_by_q);
    check([&](const Eigen::VectorXd& v) { return at(moving.q, v).momentum; }, moving.v, slopes.mass);
    check([&](const Eigen::VectorXd& v) { return at(moving.q, v).force; }, moving.v, slopes.force_by_v);
    std::vector<double>& input =
        moving.tendons.displacements.empty() ? moving.tendons.tensions : moving.tendons.displacements;
    for (double& value : input) value = std::max(value, 0.02);
    const Eigen::VectorXd middle =
        Eigen::Map<Eigen::VectorXd>(input.data(), static_cast<Eigen::Index>(input.size()));
    const RodDynamicsSlopes by = dynamics.slopes(state, moving.tendons, moving.loads);
    check(
        [&](const Eigen::VectorXd& u) {
          std::copy(u.begin(), u.end(), input.begin());
          return at(moving.q, moving.v).force;
        },
        middle, by.force_by_input);
  });
}

TEST(DynamicsSlopes, OfAStepAreThoseByDifferences) {
  for (const double rho : {0.0, 0.8, 1.0}) {
    Rod rod = two_section_robot();
    for (RodSection& section : rod.sections) {
      section.density = 6000;
      section.damping_time = 1e-3;
      section.modes = {.shear = 0, .stretch = 0, .bend = 2, .twist = 1};
    }
    RodDynamics dynamics(rod, {.spectral_radius = rho, .tolerance = 1e-10});
    const RodLoads loads{.gravity = {1, -9, 3}};
    TendonInput tendons{.tensions = {2, 0.5, 0.1, 0.2, 1, 0.3}};
    RodState state = dynamics.rest();
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(dynamics.step(state, tendons, loads, 0.01).converged());
    const RodStepSlopes slopes = dynamics.step_slopes(state, tendons, loads, 0.01);
    const Eigen::Index n = state.q.size();
    const auto stepped = [&](RodState one) {
      EXPECT_TRUE(dynamics.step(one, tendons, loads, 0.01).converged());
      return Eigen::VectorXd((Eigen::VectorXd(4 * n) << one.q, one.momentum, one.rate, one.force).finished());
    };
    const std::array<Eigen::VectorXd RodState::*, 4> parts = {&RodState::q, &RodState::momentum,
                                                              &RodState::rate, &RodState::force};
    for (std::size_t part = 0; part < 4; ++part) {
      const Eigen::VectorXd middle = state.*parts[part];
      const double size = middle.cwiseAbs().maxCoeff();
      const auto numerical = numerical_jacobian(
          [&](const Eigen::VectorXd& x) {
            RodState other = state;
            other.*parts[part] = middle + size * x;
            return stepped(other);
          },
          Eigen::VectorXd::Zero(n), 1e-2);
      for (Eigen::Index row = 0; row < 4; ++row) {
        const Eigen::MatrixXd known =
            size * slopes.by_state.block(row * n, static_cast<Eigen::Index>(part) * n, n, n);
        const double state_size = (state.*parts[static_cast<std::size_t>(row)]).cwiseAbs().maxCoeff();
        EXPECT_LE((known - numerical.value.middleRows(row * n, n)).cwiseAbs().maxCoeff(),
                  2e-6 * known.cwiseAbs().maxCoeff() + 1e-9 * state_size);
      }
    }
    const auto numerical = numerical_jacobian(
        [&](const Eigen::VectorXd& x) {
          std::copy(x.begin(), x.end(), tendons.tensions.begin());
          return stepped(state);
        },
        Eigen::Map<Eigen::VectorXd>(tendons.tensions.data(), 6).eval(), 1e-2);
    for (Eigen::Index row = 0; row < 4; ++row)
      expect_same(slopes.by_input.middleRows(row * n, n), numerical.value.middleRows(row * n, n), 1e-6);
  }
}

// A small motion around an equilibrium follows the linear model.
TEST(DynamicsSlopes, TheLinearModelIsTheMotionNearby) {
  Rod rod = two_section_robot();
  for (RodSection& section : rod.sections) {
    section.density = 6000;
    section.damping_time = 3e-3;
    section.modes = {.shear = 0, .stretch = 0, .bend = 2, .twist = 1};
  }
  const RodLoads weight{.gravity = {0, -9.81, 0}};
  const TendonInput tendons{.tensions = {2, 0.5, 0.1, 0.2, 1, 0.3}};
  const Equilibrium at = RodStatics(rod).solve(tendons, weight);
  ASSERT_TRUE(at.converged());
  RodDynamics dynamics(rod, {.spectral_radius = 1});
  const RodLinear linear = dynamics.linearize(dynamics.rest(at), tendons, weight);
  const Eigen::Index n = at.q.size();
  TendonInput more = tendons;
  more.tensions[0] += 1e-4;
  RodState state = dynamics.rest(at);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(2 * n), x_rest = x;
  const double h = 1e-3;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(2 * n, 2 * n);
  const auto midpoint = [&](const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, Eigen::VectorXd& y) {
    y = (one - h / 2 * A).partialPivLu().solve((one + h / 2 * A) * y + h * 1e-4 * B.col(0)).eval();
  };
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(dynamics.step(state, more, weight, h).converged());
    midpoint(linear.A, linear.B, x);
    midpoint(linear.A_rest, linear.B_rest, x_rest);
  }
  expect_same(x.head(n), state.q - at.q, 1e-3);
  expect_same(x_rest.head(n), x.head(n), 1e-8);
  const Eigen::Vector3d moved = dynamics.tip(state).position - at.tip.position;
  EXPECT_LE((linear.tip_by_q.topRows<3>() * x.head(n) - moved).norm(), 1e-3 * moved.norm());
  EXPECT_LT(linear.A.eigenvalues().real().maxCoeff(), 0);
}

}  // namespace
}  // namespace flexura
