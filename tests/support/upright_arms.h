#pragma once

#include <Eigen/Core>
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/mechanics/arm_rod.h"
#include "flexura/mechanics/rod.h"
#include "flexura/mechanics/rod_chain.h"
#include "flexura/mechanics/statics.h"
#include "tests/support/random_cases.h"

namespace flexura {

/// A soft arm that stands upright under its own weight, from half to 20 times of what a bare column of its
/// stiffness bears (7.84 EI / L^3: A. G. Greenhill 1881), with three tendons to each section or to the last
/// one, in channels or between disks.
struct UprightArm {
  Rod rod;
  RodLoads loads;
  /// E I, N m^2.
  double stiffness = 0;
};

inline UprightArm upright_arm(TestRandom& random) {
  UprightArm arm;
  const int sections = random.integer(1, 3);
  const double length = random.uniform(0.3, 1), radius = random.uniform(1e-3, 8e-3);
  const double modulus = std::exp(random.uniform(std::log(1e6), std::log(60e9)));
  arm.stiffness = modulus * std::numbers::pi / 4 * std::pow(radius, 4);
  const double bears = 7.84 * arm.stiffness / (std::pow(length, 3) * 9.81);
  RodSection section{.length = length / sections,
                     .radius = {radius, radius},
                     .youngs_modulus = modulus,
                     .shear_modulus = modulus / 2.66};
  section.mass_per_length = bears * std::exp(random.uniform(std::log(0.5), std::log(20)));
  section.disks = random.integer(0, 3) == 0 ? 6 : 0;
  section.modes = {.shear = 0, .stretch = 0, .bend = 4, .twist = 1};
  arm.rod.sections.assign(static_cast<std::size_t>(sections), section);
  const int first = random.integer(0, 2) == 0 ? sections - 1 : 0;
  for (int i = first; i < sections; ++i)
    for (int k = 0; k < 3; ++k)
      arm.rod.tendons.push_back({.section = static_cast<std::size_t>(i),
                                 .radius = std::max(1.5 * radius, 0.01 * length),
                                 .angle = 2 * std::numbers::pi * k / 3 + 0.7 * i});
  arm.loads.gravity = {0, 0, -9.81};
  return arm;
}

/// Bends of its sections, as tendons are pulled in for them; one in three times small ones, near upright.
inline ArmState upright_command(TestRandom& random, const UprightArm& arm) {
  ArmState state = ArmState::straight(arm.rod.sections.size());
  const double most = random.integer(0, 2) == 0 ? 0.1 : 1;
  for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-most, most);
  return state;
}

/// The least eigenvalue of the energy's second derivative along what the tendons that pull leave free, by
/// differences of the residual, over the stiffness of a section's bend; and the residual, likewise. Tendons
/// that are just taut may carry a tension that all of them share: such tensions cancel each other in the
/// balance, and all that they do is to hold the rod where any motion would lengthen one of them.
struct RestCheck {
  double residual = 0, least_stiffness = 0;
};

/// The tensions beside those of the equilibrium that tendons at their limit may share without moving the rod:
/// ten times what a bend of one radian takes, in the only direction in which they cancel. Empty: there is
/// none.
inline std::vector<double> shared_tensions(const UprightArm& arm, const Equilibrium& at,
                                           const std::vector<double>& pulled, const RodChain& chain) {
  std::vector<Eigen::Index> limit;
  for (std::size_t i = 0; i < pulled.size(); ++i)
    if (at.tensions[i] > 0 || std::abs(at.displacements[i] - pulled[i]) < 1e-7 * arm.rod.length())
      limit.push_back(static_cast<Eigen::Index>(i));
  if (limit.empty()) return {};
  const Eigen::MatrixXd slopes = chain.length_slopes()(Eigen::all, limit);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(slopes, Eigen::ComputeThinU | Eigen::ComputeFullV);
  const Eigen::Index last = slopes.cols() - 1;
  if (last >= slopes.rows() || svd.singularValues()[last] > 1e-7 * svd.singularValues()[0]) return {};
  Eigen::VectorXd shares = svd.matrixV().col(last);
  if (shares.sum() < 0) shares = -shares;
  if (!(shares.minCoeff() > -1e-9)) return {};
  std::vector<double> tensions = at.tensions;
  for (std::size_t k = 0; k < limit.size(); ++k)
    tensions[static_cast<std::size_t>(limit[k])] +=
        10 * shares[static_cast<Eigen::Index>(k)] * arm.stiffness /
        (arm.rod.sections.front().length * arm.rod.tendons.front().radius);
  return tensions;
}

inline RestCheck check_rest(const UprightArm& arm, const Equilibrium& at, const std::vector<double>& pulled) {
  RodChain chain(arm.rod);
  const double length = arm.rod.sections.front().length;
  chain.balance(at.q, at.tensions, arm.loads, 1);
  std::vector<double> tensions = shared_tensions(arm, at, pulled, chain);
  if (tensions.empty()) tensions = at.tensions;
  const auto residual = [&](const Eigen::VectorXd& q) {
    chain.balance(q, tensions, arm.loads, 1);
    return Eigen::VectorXd(chain.residual().cwiseQuotient(chain.scales()));
  };
  const Eigen::Index n = chain.size();
  const double unit = arm.stiffness / length, step = 1e-5;
  Eigen::MatrixXd hessian(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    const Eigen::VectorXd aside = Eigen::VectorXd::Unit(n, j) * (step / chain.scales()[j]);
    hessian.col(j) = (residual(at.q + aside) - residual(at.q - aside)) / (2 * step * unit);
  }
  RestCheck check{.residual = residual(at.q).cwiseAbs().maxCoeff() / unit};
  std::vector<Eigen::Index> taut;
  for (std::size_t i = 0; i < pulled.size(); ++i)
    if (at.tensions[i] > 0) taut.push_back(static_cast<Eigen::Index>(i));
  Eigen::MatrixXd free = Eigen::MatrixXd::Identity(n, n);
  if (!taut.empty()) {
    const Eigen::MatrixXd held =
        chain.length_slopes()(Eigen::all, taut)
            .cwiseQuotient(chain.scales().replicate(1, static_cast<Eigen::Index>(taut.size())));
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(held);
    qr.setThreshold(1e-9);
    const Eigen::MatrixXd all = qr.householderQ();
    free = all.rightCols(n - qr.rank());
  }
  const Eigen::MatrixXd reduced = free.transpose() * (hessian + hessian.transpose()) * free / 2;
  check.least_stiffness = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(reduced, Eigen::EigenvaluesOnly)
                              .eigenvalues()
                              .minCoeff();
  return check;
}

/// What a random arm is asked for from rest, and what is asked for next, near to that.
inline void expect_upright_arm_rests(TestRandom& random) {
  const UprightArm arm = upright_arm(random);
  RodStatics statics(arm.rod);
  const bool is_held = random.integer(0, 3) != 0;
  ArmState command = upright_command(random, arm);
  std::vector<double> tensions;
  for (const TendonRoute& tendon : arm.rod.tendons)
    tensions.push_back(random.integer(0, 1) * random.uniform(0, 2) * arm.stiffness /
                       (arm.rod.length() * tendon.radius));
  Equilibrium at;
  for (int ask = 0; ask < 2; ++ask) {
    const TendonInput input = is_held
                                  ? TendonInput{.displacements = arc_displacements(arm.rod, command).pulled}
                                  : TendonInput{.tensions = tensions};
    EXPECT_TRUE(statics.solve(input, arm.loads, at).converged());
    at = statics.settle(input, arm.loads, at);
    ASSERT_TRUE(at.converged()) << words(at.end);
    EXPECT_TRUE(at.stable);
    const RestCheck check = check_rest(arm, at, input.displacements);
    EXPECT_LE(check.residual, 1e-6);
    EXPECT_GE(check.least_stiffness, -1e-4);
    for (const double tension : at.tensions) EXPECT_GE(tension, 0);
    for (Eigen::Vector2d& bend : command.bends) bend += random.vector<2>(-0.05, 0.05);
    for (double& tension : tensions) tension *= random.uniform(0.9, 1.1);
  }
}

}  // namespace flexura
