#include "flexura/mechanics/inverse_dynamics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

namespace flexura {
namespace {

// The two-section robot with a mass and a viscosity.
Rod robot_in_motion(StrainModes modes) {
  Rod rod = two_section_robot();
  for (RodSection& section : rod.sections) {
    section.density = 6000;
    section.damping_time = 2e-3;
    section.modes = modes;
  }
  return rod;
}

// One soft section that bends as an arc, under four tendons of which pairs pull against each other.
Rod arc_under_four_tendons() {
  Rod rod = soft_tentacle();
  rod.sections[0].modes = {.shear = 0, .stretch = 0, .bend = 1, .twist = 0};
  rod.sections[0].damping_time = 0.01;
  for (const double angle : {0.0, 0.5, 1.0, 1.5})
    rod.tendons.push_back({.section = 0, .radius = 0.025, .angle = angle * std::numbers::pi});
  return rod;
}

const RodLoads level_weight{.gravity = {0, -9.81, 0}};

TEST(InverseDynamics, NeededForcesAreThoseThatTheTendonsMake) {
  for_random_cases(10, [](TestRandom& random) {
    Rod rod = random_rod(random);
    for (RodSection& section : rod.sections) {
      section.damping_time = random.uniform(0, 0.01);
      section.modes = {.shear = 1, .stretch = 1, .bend = 2, .twist = 2};
    }
    RodDynamics dynamics(rod);
    const RodLoads loads = random_loads(random, rod);
    const TendonInput tendons{.tensions = random_tensions(random, rod, 5)};
    Eigen::VectorXd q(dynamics.chain().size()), v(q.size());
    for (Eigen::Index j = 0; j < q.size(); ++j) {
      const double size = (dynamics.chain().scales()[j] == 1 ? 0.02 : 1) / dynamics.chain().scales()[j];
      q[j] = size * random.uniform(-1, 1);
      v[j] = size * random.uniform(-5, 5);
    }
    const Eigen::VectorXd a = dynamics.acceleration(q, v, tendons, loads);
    const Eigen::VectorXd needed = dynamics.needed_forces(q, v, a, loads);
    const Eigen::VectorXd made =
        -dynamics.lengths_by_q(q).transpose() *
        Eigen::Map<const Eigen::VectorXd>(tendons.tensions.data(),
                                          static_cast<Eigen::Index>(tendons.tensions.size()));
    const double size = (dynamics.mass_matrix(q) * a).cwiseAbs().maxCoeff() +
                        (dynamics.stiffness_matrix() * q).cwiseAbs().maxCoeff();
    EXPECT_LE((needed - made).cwiseAbs().maxCoeff(), 1e-9 * size);
  });
}

TEST(InverseDynamics, OfAMotionUnderKnownTensionsGivesThemBack) {
  const Rod rod = robot_in_motion({.shear = 1, .stretch = 1, .bend = 3, .twist = 1});
  RodDynamics dynamics(rod, {.spectral_radius = 1, .tolerance = 1e-10});
  RodState state = dynamics.rest();
  const auto tensions_at = [](double t) {
    std::vector<double> tensions;
    for (const double i : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0})
      tensions.push_back(2 + 1.5 * std::sin(20 * t + i) - (i == 2 ? 0.4 : 0));
    return tensions;
  };
  const double h = 1e-4;
  std::vector<RodMotionSample> motion;
  std::vector<std::vector<double>> known;
  for (int step = 0; step < 300; ++step) {
    ASSERT_TRUE(
        dynamics.step(state, {.tensions = tensions_at(state.time + h / 2)}, level_weight, h).converged());
    if (step % 50 != 49) continue;
    const Eigen::VectorXd v = dynamics.velocity(state);
    known.push_back(tensions_at(state.time));
    motion.push_back({.time = state.time,
                      .q = state.q,
                      .v = v,
                      .a = dynamics.acceleration(state.q, v, {.tensions = known.back()}, level_weight)});
  }
  const std::vector<TensionFit> fits = inverse_dynamics(dynamics, motion, level_weight);
  ASSERT_EQ(fits.size(), known.size());
  for (std::size_t k = 0; k < fits.size(); ++k) {
    EXPECT_TRUE(fits[k].is_determined);
    EXPECT_LT(fits[k].residual(), 1e-6);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(fits[k].tensions[i], known[k][i], 1e-5);
  }
}

// The accelerations are those of the motion alone, by differences of its rates.
TEST(InverseDynamics, TakesAccelerationsByDifferencesOfASimulatedMotion) {
  RodDynamics dynamics(arc_under_four_tendons(), {.spectral_radius = 1, .tolerance = 1e-10});
  RodState state = dynamics.rest();
  const TendonInput tendons{.tensions = {6, 0, 0, 3}};
  const double h = 1e-3;
  std::vector<Eigen::VectorXd> q, v;
  for (int step = 0; step < 100; ++step) {
    ASSERT_TRUE(dynamics.step(state, tendons, level_weight, h).converged());
    q.push_back(state.q);
    v.push_back(dynamics.velocity(state));
  }
  for (const std::size_t k : {20u, 50u, 90u}) {
    const TensionFit fit = inverse_dynamics(
        dynamics, {.q = q[k], .v = v[k], .a = (v[k + 1] - v[k - 1]) / (2 * h)}, level_weight);
    EXPECT_FALSE(fit.is_determined);  // But of least effort are those that pull.
    EXPECT_LT(fit.residual(), 1e-4);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(fit.tensions[i], tendons.tensions[i], 0.02);
  }
}

TEST(InverseDynamics, GravityCompensationHoldsAPoseOfStatics) {
  const Rod rod = robot_in_motion({.shear = 1, .stretch = 1, .bend = 3, .twist = 2});
  const std::vector<double> tensions = {3, 0.5, 1, 0.2, 2, 0.7};
  const Equilibrium at = RodStatics(rod).solve({.tensions = tensions}, level_weight);
  ASSERT_TRUE(at.converged());
  RodDynamics dynamics(rod);
  const TensionFit fit = gravity_compensation(dynamics, at.q, level_weight);
  EXPECT_LT(fit.residual(), 1e-6);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(fit.tensions[i], tensions[i], 1e-5);
  // Where less than that may be pulled, the nearest within bounds, and what is missing.
  const TensionFit bounded = gravity_compensation(dynamics, at.q, level_weight, {.most = {1, 9, 9, 9, 9, 9}});
  EXPECT_EQ(bounded.tensions[0], 1);
  EXPECT_GT(bounded.residual(), 0.1);
  EXPECT_LE(bounded.residual(), 1);
}

TEST(InverseDynamics, TellsWhatTooFewTendonsMiss) {
  const Rod rod = robot_in_motion({.shear = 0, .stretch = 0, .bend = 3, .twist = 1});
  RodDynamics dynamics(rod);
  const Eigen::Index n = dynamics.chain().size();
  Eigen::VectorXd q = Eigen::VectorXd::Zero(n);
  const auto scales = dynamics.chain().scales();
  for (Eigen::Index j = 0; j < n; ++j) q[j] = 0.3 * std::cos(static_cast<double>(3 * j)) / scales[j];
  const TensionFit fit = gravity_compensation(dynamics, q, level_weight);
  EXPECT_GT(fit.residual(), 0.1);
  EXPECT_LE(fit.residual(), 1);
  // No tensions nearby miss less.
  const Eigen::MatrixXd stiffness = dynamics.stiffness_matrix(), lengths = dynamics.lengths_by_q(q);
  for (int i = 0; i < 6; ++i) {
    for (const double change : {-0.01, 0.01}) {
      if (fit.tensions[static_cast<std::size_t>(i)] + change < 0) continue;
      const Eigen::VectorXd missing = fit.missing + change * lengths.row(i).transpose();
      EXPECT_GT(0.5 * missing.dot(stiffness.ldlt().solve(missing)), fit.missing_energy);
    }
  }
}

// A circle of bends: q = r (cos wt, sin wt) from a start beside it.
TEST(ComputedTorque, FollowsAMotionWithAnErrorThatFalls) {
  RodDynamics dynamics(arc_under_four_tendons(), {.spectral_radius = 1});
  const double radius = 1.5, rate = 6, h = 1e-3;
  const auto desired = [&](double t) {
    const Eigen::Vector2d out(std::cos(rate * t), std::sin(rate * t)), along(-out.y(), out.x());
    return RodMotionSample{
        .time = t, .q = radius * out, .v = radius * rate * along, .a = -radius * rate * rate * out};
  };
  const ComputedTorqueGains gains{.position = 400, .velocity = 40};
  RodState state = dynamics.start(0.6 * desired(0).q, Eigen::Vector2d::Zero(), {}, level_weight);
  std::vector<double> errors;
  for (int step = 0; step < 1500; ++step) {
    const TensionFit fit = computed_torque(dynamics, state.q, dynamics.velocity(state), desired(state.time),
                                           gains, level_weight);
    EXPECT_LT(fit.residual(), 1e-4);
    ASSERT_TRUE(dynamics.step(state, {.tensions = fit.tensions}, level_weight, h).converged());
    errors.push_back((state.q - desired(state.time).q).norm());
  }
  // e'' + 40 e' + 400 e = 0 from e = 0.4 r, e' = r w, as far as tensions stay for a step.
  for (const int step : {50, 100, 200, 300}) {
    const double t = step * h, slow = std::exp(-20 * t);
    const Eigen::Vector2d start(-0.4 * radius, 0), speed(0, -radius * rate);
    const double known = (slow * (start + t * (speed + 20 * start))).norm();
    EXPECT_NEAR(errors[static_cast<std::size_t>(step) - 1], known, 0.02) << step;
  }
  EXPECT_LT(*std::max_element(errors.begin() + 700, errors.end()), 0.02 * radius);
}

TEST(InverseDynamics, RefusesWhatIsNoMotion) {
  RodDynamics dynamics(arc_under_four_tendons());
  const Eigen::VectorXd two = Eigen::Vector2d(0.1, 0.2), three = Eigen::Vector3d(1, 2, 3);
  EXPECT_THROW((void)gravity_compensation(dynamics, three, {}), std::invalid_argument);
  EXPECT_THROW((void)inverse_dynamics(dynamics, {.q = two, .v = two, .a = three}, {}), std::invalid_argument);
  EXPECT_THROW((void)gravity_compensation(dynamics, two * std::nan(""), {}), std::invalid_argument);
  EXPECT_THROW((void)gravity_compensation(dynamics, two, {}, {.most = {1, 2}}), std::invalid_argument);
  EXPECT_THROW((void)gravity_compensation(dynamics, two, {}, {.most = {1, 2, 3, -1}}), std::invalid_argument);
  EXPECT_THROW((void)gravity_compensation(dynamics, two, {.gravity = {std::nan(""), 0, 0}}),
               std::invalid_argument);
  EXPECT_THROW((void)computed_torque(dynamics, two, two, {.q = two, .v = two, .a = two},
                                     {.position = std::nan("")}, {}),
               std::invalid_argument);
  EXPECT_THROW((void)computed_torque(dynamics, two, two, {.q = three, .v = two, .a = two}, {}, {}),
               std::invalid_argument);
}

TEST(InverseDynamics, WithoutTendonsAllIsMissing) {
  Rod rod = arc_under_four_tendons();
  rod.tendons.clear();
  RodDynamics dynamics(rod);
  const TensionFit fit = gravity_compensation(dynamics, Eigen::Vector2d(1, 0), {});
  EXPECT_TRUE(fit.tensions.empty());
  EXPECT_EQ(fit.residual(), 1);
  EXPECT_EQ(gravity_compensation(dynamics, Eigen::Vector2d::Zero(), {}).residual(), 0);
}

}  // namespace
}  // namespace flexura
