#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "flexura/math/derivative_check.h"
#include "flexura/math/so3.h"
#include "flexura/mechanics/statics.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

namespace flexura {
namespace {

Rod coarse(Rod rod, TestRandom& random) {
  for (RodSection& section : rod.sections) {
    section.modes = {.shear = 1, .stretch = 2, .bend = 3, .twist = 2};
    if (random.integer(0, 2) == 0) section.disks = random.integer(2, 6);
  }
  return rod;
}

TEST(StaticsSlopes, TheTangentIsTheDerivativeOfTheResidual) {
  for_random_cases(25, [](TestRandom& random) {
    const Rod rod = coarse(random_rod(random), random);
    const std::vector<double> tensions = random_tensions(random, rod, 6);
    const RodLoads loads = random_loads(random, rod);
    RodChain chain(rod);
    const Eigen::VectorXd unit = chain.scales().cwiseInverse();
    Eigen::VectorXd at(chain.size());
    for (double& value : at) value = random.uniform(-0.5, 0.5);
    for (std::size_t i = 0; i < chain.elements().size(); ++i)
      for (int c = 0; c < 3; ++c)
        at.segment(chain.first(i) + chain.elements()[i].grid().first[static_cast<std::size_t>(c)],
                   chain.elements()[i].grid().count[static_cast<std::size_t>(c)]) *= 0.1;
    const auto residual = [&](const Eigen::VectorXd& q) {
      chain.balance(q.cwiseProduct(unit), tensions, loads, 0.7);
      return Eigen::VectorXd(chain.residual().cwiseProduct(unit));
    };
    const NumericalJacobian numerical = numerical_jacobian(residual, at, 0.02);
    (void)residual(at);
    ASSERT_TRUE(chain.factor());
    // solve() has the inverse: times the derivative it is the identity.
    Eigen::MatrixXd product = unit.cwiseInverse().asDiagonal() * numerical.value;
    chain.solve(product);
    product = unit.cwiseInverse().asDiagonal() * product;
    EXPECT_LE((product - Eigen::MatrixXd::Identity(at.size(), at.size())).cwiseAbs().maxCoeff(), 2e-5);
  });
}

TEST(StaticsSlopes, TheColumnsAreTheDerivativeOfTheTip) {
  for_random_cases(10, [](TestRandom& random) {
    RodChain chain(coarse(random_rod(random), random));
    Eigen::VectorXd q(chain.size());
    for (double& value : q) value = random.uniform(-0.2, 0.2);
    chain.place_with_columns(q);
    const Pose at = chain.tip();
    RodElement::Columns J(6, q.size());
    chain.columns_at(chain.elements().size() - 1, chain.elements().back().poses().size() - 1, J);
    const auto moved = [&](const Eigen::VectorXd& to) {
      chain.place(to);
      Eigen::VectorXd twist(6);
      twist << chain.tip().position - at.position, so3_log(chain.tip().rotation * at.rotation.transpose());
      return twist;
    };
    const Eigen::MatrixXd numerical = numerical_jacobian(moved, q, 0.02).value;
    for (Eigen::Index c = 0; c < q.size(); ++c) J.col(c).head<3>() += J.col(c).tail<3>().cross(at.position);
    EXPECT_LE((J - numerical).cwiseAbs().maxCoeff(), 1e-8);
  });
}

// Expects the slopes at the equilibrium near `near` to be those by differences.
void expect_slopes(RodStatics& statics, const TendonInput& input, const RodLoads& loads,
                   const Equilibrium& near) {
  const Equilibrium at = statics.solve(input, loads, near);
  if (at.end == StaticsEnd::disks_meet) return;
  ASSERT_TRUE(at.converged());
  const EquilibriumSlopes slopes = statics.slopes();
  const bool by_tension = input.displacements.empty();
  const std::vector<double>& values = by_tension ? input.tensions : input.displacements;
  // Differences by displacements: curvature of up to 1e5 per m^2 makes them wrong by its share of the squared
  // step (1e-5 of the value at 1e-5 m); below 1e-6 m the equilibrium's tolerance of 1e-10 shows.
  const double step = by_tension ? 1e-3 : 1e-6;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (at.tensions[i] == 0) continue;
    std::array<Equilibrium, 2> beside;
    for (const std::size_t side : {0u, 1u}) {
      TendonInput moved = input;
      (by_tension ? moved.tensions : moved.displacements)[i] += side == 0 ? -step : step;
      beside[side] = statics.solve(moved, loads, at);
      ASSERT_TRUE(beside[side].converged());
    }
    const auto column = static_cast<Eigen::Index>(i);
    const Eigen::Vector3d tip = (beside[1].tip.position - beside[0].tip.position) / (2 * step);
    const Eigen::Vector3d found = slopes.tip_by_input.col(column).head<3>();
    EXPECT_LE((found - tip).norm(), 2e-6 * (1 + tip.norm())) << i;
    for (std::size_t j = 0; j < values.size(); ++j) {
      const double tension = (beside[1].tensions[j] - beside[0].tensions[j]) / (2 * step);
      EXPECT_NEAR(slopes.tensions_by_input(static_cast<Eigen::Index>(j), column), tension,
                  2e-5 * (1 + std::abs(tension)));
    }
  }
  // By a force and a moment at the tip.
  for (int c = 0; c < 6; ++c) {
    std::array<Pose, 2> beside;
    for (const std::size_t side : {0u, 1u}) {
      RodLoads moved = loads;
      EndLoad end{.section = statics.chain().rod().sections.size() - 1};
      (c < 3 ? end.force : end.moment)[c % 3] = side == 0 ? -1e-5 : 1e-5;
      moved.ends.push_back(end);
      const Equilibrium there = statics.solve(input, moved, at);
      ASSERT_TRUE(there.converged());
      beside[side] = there.tip;
    }
    const Eigen::Vector3d tip = (beside[1].position - beside[0].position) / 2e-5;
    EXPECT_LE((slopes.tip_by_tip.col(c).head<3>() - tip).norm(), 1e-4 * (1 + tip.norm())) << c;
  }
}

// By stiffness and weight of each section, at constant tensions and at constant displacements.
TEST(StaticsSlopes, ByParametersAreThoseByDifferences) {
  for_random_cases(12, [](TestRandom& random) {
    Rod rod = coarse(random_rod(random), random);
    for (RodSection& section : rod.sections) {
      section.stiffness = section.stiffness_at(0.5);
      section.mass_per_length = section.mass_per_length_at(0.5);
    }
    for (TendonRoute& tendon : rod.tendons) tendon.compliance = random.uniform(1e-4, 1e-3);
    const RodLoads loads{.gravity = random.vector<3>(-10.0, 10.0)};
    RodStatics statics(rod);
    const Equilibrium pulled =
        statics.solve({.tensions = std::vector<double>(rod.tendons.size(), 1.5)}, loads);
    ASSERT_TRUE(pulled.converged());
    TendonInput input{.tensions = pulled.tensions};
    if (random.integer(0, 1) == 0) input = {.displacements = pulled.displacements};
    ASSERT_TRUE(statics.solve(input, loads, pulled).converged());
    const Eigen::MatrixXd slopes = statics.slopes().tip_by_parameters;
    ASSERT_EQ(slopes.cols(), 5 * static_cast<Eigen::Index>(rod.sections.size()));
    // Soft equilibria (metres by a relative change of 1) need differences extrapolated to step 0.
    constexpr double step = 1e-4;
    for (std::size_t i = 0; i < rod.sections.size(); ++i) {
      for (int parameter = 0; parameter < 5; ++parameter) {
        const auto tip = [&](double change) {
          Rod other = rod;
          const double factor = 1 + change;
          Vector6d& k = *other.sections[i].stiffness;
          if (parameter == 0) k.head<2>() *= factor;
          if (parameter == 1) k[2] *= factor;
          if (parameter == 2) k.segment<2>(3) *= factor;
          if (parameter == 3) k[5] *= factor;
          if (parameter == 4) *other.sections[i].mass_per_length *= factor;
          const Equilibrium there = RodStatics(other).solve(input, loads, pulled);
          EXPECT_TRUE(there.converged());
          return there.tip.position;
        };
        const auto difference = [&](double h) { return Eigen::Vector3d((tip(h) - tip(-h)) / (2 * h)); };
        const Eigen::Vector3d by = (4 * difference(step) - difference(2 * step)) / 3;
        EXPECT_LE((slopes.col(5 * static_cast<Eigen::Index>(i) + parameter).head<3>() - by).norm(),
                  1e-8 + 1e-7 * by.norm())
            << parameter;
      }
    }
  });
}

TEST(StaticsSlopes, ByTensionsAreThoseByDifferences) {
  for_random_cases(15, [](TestRandom& random) {
    const Rod rod = coarse(random_rod(random, random.integer(0, 1) == 0 ? 0.3 : 0), random);
    RodStatics statics(rod);
    std::vector<double> tensions = random_tensions(random, rod, 5);
    for (double& tension : tensions) tension += 0.1;
    expect_slopes(statics, {.tensions = tensions}, random_loads(random, rod), {});
  });
}

TEST(StaticsSlopes, ByDisplacementsAreThoseByDifferences) {
  for_random_cases(15, [](TestRandom& random) {
    Rod rod = coarse(random_rod(random, random.integer(0, 1) == 0 ? 0.3 : 0), random);
    for (TendonRoute& tendon : rod.tendons) tendon.compliance = random.uniform(1e-4, 1e-3);
    RodStatics statics(rod);
    const RodLoads loads = random_loads(random, rod);
    std::vector<double> tensions(rod.tendons.size());
    for (double& tension : tensions) tension = random.uniform(0.5, 3);
    const Equilibrium pulled = statics.solve({.tensions = tensions}, loads);
    ASSERT_TRUE(pulled.converged());
    expect_slopes(statics, {.displacements = pulled.displacements}, loads, pulled);
  });
}

TEST(StaticsSlopes, ARobotThatIsTurnedWithItsLoadsBendsTheSame) {
  for_random_cases(20, [](TestRandom& random) {
    Rod rod = random_rod(random);
    const std::vector<double> tensions = random_tensions(random, rod, 6);
    RodLoads loads = random_loads(random, rod);
    const Equilibrium at = RodStatics(rod).solve({.tensions = tensions}, loads);
    const double angle = random.uniform(-3, 3);
    const Eigen::Matrix3d R = so3_exp({0, 0, angle});
    loads.gravity = R * loads.gravity;
    loads.per_length = R * loads.per_length;
    for (EndLoad& end : loads.ends) {
      end.force = R * end.force;
      end.moment = R * end.moment;
    }
    for (RodSection& section : rod.sections) {
      for (Eigen::Vector3d& coefficient : section.rest_curvature) coefficient = R * coefficient;
      for (PointMass& mass : section.masses) mass.offset = R * mass.offset;
    }
    for (TendonRoute& tendon : rod.tendons) {
      tendon.angle += angle;
      tendon.x.resize(3);
      tendon.y.resize(3);
      for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector3d turned = R * Eigen::Vector3d(tendon.x[i], tendon.y[i], 0);
        tendon.x[i] = turned.x();
        tendon.y[i] = turned.y();
      }
    }
    const Equilibrium turned = RodStatics(rod).solve({.tensions = tensions}, loads);
    ASSERT_TRUE(at.converged() && turned.converged());
    EXPECT_LE((turned.tip.position - R * at.tip.position).norm(), 1e-9);
    EXPECT_NEAR(turned.strain_energy, at.strain_energy, 1e-9 * (1 + at.strain_energy));
  });
}

}  // namespace
}  // namespace flexura
