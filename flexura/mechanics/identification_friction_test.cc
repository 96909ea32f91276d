#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "flexura/mechanics/identification.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"

// The friction of tendons by how a rod moved.
namespace flexura {
namespace {

using Kind = RodParameter::Kind;

Rod rubbing_tentacle(double friction) {
  Rod rod = soft_tentacle();
  rod.sections[0].length = 0.4;
  rod.sections[0].modes = {.shear = 0, .stretch = 0, .bend = 2, .twist = 0};
  for (const double angle : {0.0, 120.0, 240.0})
    rod.tendons.push_back(
        {.section = 0, .radius = 0.02, .angle = angle * std::numbers::pi / 180, .friction = friction});
  return rod;
}

constexpr double true_stiffness = 1.2, true_damping = 0.06, true_friction = 0.25;
const std::vector<RodParameter> sought_with_friction = {
    {.kind = Kind::bends}, {.kind = Kind::damping}, {.kind = Kind::friction}};
const Eigen::Vector3d truly_with_friction(true_stiffness, true_damping, true_friction);

Rod true_rubbing_tentacle() {
  Rod rod = rubbing_tentacle(true_friction);
  RodSection& section = rod.sections[0];
  section.damping = Vector6d(true_damping * section.stiffness_at(0));
  section.stiffness = Vector6d(true_stiffness * section.stiffness_at(0));
  return rod;
}

// Tendons pull in turns, so that they slide all the time.
std::vector<double> tensions_in_turns(double time) {
  std::vector<double> tensions;
  for (const double phase : {0.0, 2.1, 4.2})
    tensions.push_back(40 + 30 * std::sin(5 * time + phase) + 6 * std::sin(11 * time + 2 * phase));
  return tensions;
}

RodMotionRecord pulled_in_turns() {
  constexpr double sample_time = 8e-3;
  constexpr int pieces = 8;
  constexpr double h = sample_time / pieces;
  RodDynamics dynamics(true_rubbing_tentacle(), {.spectral_radius = 1, .tolerance = 1e-9});
  const RodLoads weight{.gravity = {0, 0, 9.81}};
  RodState state = dynamics.rest();
  RodMotionRecord record{.samples = {}, .loads = weight};
  for (int k = -60; k <= 300; ++k) {
    const double time = k * sample_time;
    if (k >= 0)
      record.samples.push_back(
          {.time = time, .q = state.q, .v = dynamics.velocity(state), .tensions = tensions_in_turns(time)});
    for (int i = 0; i < pieces; ++i)
      EXPECT_TRUE(
          dynamics.step(state, {.tensions = tensions_in_turns(time + (i + 0.5) * h)}, weight, h).converged());
  }
  return record;
}

RodMotionRecord with_errors(RodMotionRecord record, double q_noise, double v_noise, TestRandom& random) {
  const Eigen::Index n = record.samples[0].q.size();
  record.q_noise = Eigen::VectorXd::Constant(n, q_noise);
  record.v_noise = Eigen::VectorXd::Constant(n, v_noise);
  for (RodMotionRecordSample& sample : record.samples) {
    for (double& value : sample.q) value += q_noise * normal_number(random);
    for (double& value : *sample.v) value += v_noise * normal_number(random);
  }
  return record;
}

TEST(IdentificationOfFriction, OfAnExactRecordGivesItBack) {
  const RodMotionRecord record = pulled_in_turns();
  for (const double nominal : {0.0, 0.5}) {
    const Identification found = identify(rubbing_tentacle(nominal), sought_with_friction, record);
    EXPECT_TRUE(found.converged);
    for (Eigen::Index g = 0; g < 3; ++g) {
      EXPECT_TRUE(found.is_observable[static_cast<std::size_t>(g)]);
      EXPECT_NEAR(found.values[g], truly_with_friction[g], 0.02 * truly_with_friction[g]) << g;
    }
  }
  // Without it the others are wrong by what friction does.
  const Identification smooth =
      identify(rubbing_tentacle(0), {sought_with_friction.begin(), sought_with_friction.end() - 1}, record);
  EXPECT_GT((smooth.values - truly_with_friction.head(2))
                .cwiseQuotient(truly_with_friction.head(2))
                .cwiseAbs()
                .maxCoeff(),
            0.05);
}

TEST(IdentificationOfFriction, TellsHowWrongItIsUnderNoise) {
  const RodMotionRecord exact = pulled_in_turns();
  TestRandom random(case_seed(0));
  const int seeds = 12;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  double distance = 0, misfit = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const Identification found =
        identify(rubbing_tentacle(0.1), sought_with_friction, with_errors(exact, 0.05, 0.5, random));
    EXPECT_TRUE(found.converged);
    const Eigen::Vector3d error = found.values - truly_with_friction,
                          parts = error.cwiseQuotient(found.sigma);
    EXPECT_LT(parts.cwiseAbs().maxCoeff(), 4.5);
    EXPECT_LT(found.sigma.cwiseQuotient(truly_with_friction).maxCoeff(), 0.1);
    squares += parts.cwiseAbs2() / seeds;
    distance += error.dot(found.covariance.ldlt().solve(error)) / seeds;
    misfit += found.misfit / seeds;
  }
  // Of 12 seeds the mean square is 1 +- 0.41, the mean of the distance 3 +- 0.7.
  EXPECT_GT(squares.minCoeff(), 0.2);
  EXPECT_LT(squares.maxCoeff(), 3);
  EXPECT_NEAR(distance, 3, 2.5);
  EXPECT_NEAR(misfit, 1, 0.4);
}

// A rod that hangs still says nothing of its friction.
TEST(IdentificationOfFriction, FlagsWhatDoesNotSlide) {
  RodMotionRecord record;
  for (int k = 0; k < 100; ++k)
    record.samples.push_back({.time = 0.01 * k,
                              .q = Eigen::VectorXd::Zero(4),
                              .v = Eigen::VectorXd::Zero(4),
                              .tensions = {1, 1, 1}});
  const Identification found = identify(rubbing_tentacle(0.1), sought_with_friction, record);
  EXPECT_FALSE(found.is_observable[2]);
  EXPECT_EQ(found.values[2], 0.1);
  EXPECT_TRUE(std::isinf(found.sigma[2]));
  EXPECT_THROW(
      (void)identify(rubbing_tentacle(0), {{.kind = Kind::friction}, {.kind = Kind::friction}}, record),
      std::invalid_argument);
  EXPECT_THROW((void)identify(rubbing_tentacle(0), {{.kind = Kind::friction, .section = 1}}, record),
               std::invalid_argument);
}

}  // namespace
}  // namespace flexura
