#include "flexura/mechanics/identification.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "flexura/mechanics/dynamics.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using Kind = RodParameter::Kind;

// What is believed: a soft rod of two sections with three tendons to each one's end.
Rod nominal_tentacle(StrainModes modes = {.shear = 0, .stretch = 0, .bend = 2, .twist = 0}) {
  Rod rod = soft_tentacle();
  rod.sections[0].length = 0.3;
  rod.sections[0].modes = modes;
  rod.sections.push_back(rod.sections[0]);
  for (const std::size_t end : {0u, 1u})
    for (const double angle : {0.0, 120.0, 240.0})
      rod.tendons.push_back({.section = end, .radius = 0.02, .angle = angle * std::numbers::pi / 180});
  return rod;
}

struct TrueTentacle {
  double first = 1.25, second = 0.8, damping = 0.05, mass = 1.1;
};

// Stiffness and mass by factors, and a damping of so many seconds of the stiffness that is believed.
Rod true_tentacle(Rod rod, const TrueTentacle& truth) {
  for (std::size_t i = 0; i < 2; ++i) {
    RodSection& section = rod.sections[i];
    section.damping = Vector6d(truth.damping * section.stiffness_at(0));
    section.stiffness = Vector6d((i == 0 ? truth.first : truth.second) * section.stiffness_at(0));
    section.density *= truth.mass;
  }
  return rod;
}

constexpr double sample_time = 8e-3;

// Tendons pull from rest on, and another way after a second.
RodMotionRecord step_response(const Rod& rod, bool with_rates, const RodLoads& loads = soft_tentacle_weight(),
                              const std::vector<double>& pull = {4, 0, 3, 0, 5, 0},
                              const std::vector<double>& back = {0, 5, 0, 3, 0, 4}) {
  RodDynamics dynamics(rod, {.spectral_radius = 1, .tolerance = 1e-10});
  RodState state = dynamics.rest();
  RodMotionRecord record{.samples = {}, .loads = loads};
  for (int k = 0; k <= 250; ++k) {
    const bool is_second = k * sample_time > 1 - 1e-9;
    RodMotionRecordSample sample{.time = state.time, .q = state.q, .tensions = is_second ? back : pull};
    if (with_rates) sample.v = dynamics.velocity(state);
    record.samples.push_back(sample);
    for (int i = 0; i < 8; ++i) {
      // The jump lies half-way between two samples.
      const bool is_after = (k + (i + 0.5) / 8 + 0.5) * sample_time > 1;
      EXPECT_TRUE(
          dynamics.step(state, {.tensions = is_after ? back : pull}, loads, sample_time / 8).converged());
    }
  }
  return record;
}

// Errors of each mode, 1/m, and of its rate.
RodMotionRecord noisy(RodMotionRecord record, double q_noise, double v_noise, TestRandom& random) {
  const Eigen::Index n = record.samples[0].q.size();
  record.q_noise = Eigen::VectorXd::Constant(n, q_noise);
  if (record.samples[0].v) record.v_noise = Eigen::VectorXd::Constant(n, v_noise);
  for (RodMotionRecordSample& sample : record.samples) {
    for (double& value : sample.q) value += q_noise * normal_number(random);
    if (sample.v)
      for (double& value : *sample.v) value += v_noise * normal_number(random);
  }
  return record;
}

const std::vector<RodParameter> all_of_it = {{.kind = Kind::bends, .section = 0},
                                             {.kind = Kind::bends, .section = 1},
                                             {.kind = Kind::damping},
                                             {.kind = Kind::mass}};
const Eigen::Vector4d known_values(1.25, 0.8, 0.05, 1.1);

TEST(Identification, OfAnExactRecordGivesTheRodBack) {
  for (const bool with_rates : {true, false}) {
    const RodMotionRecord record = step_response(true_tentacle(nominal_tentacle(), {}), with_rates);
    const Identification found = identify(nominal_tentacle(), all_of_it, record);
    for (Eigen::Index g = 0; g < 4; ++g) {
      EXPECT_TRUE(found.is_observable[static_cast<std::size_t>(g)]);
      EXPECT_NEAR(found.values[g], known_values[g], 3e-3 * known_values[g]) << g << with_rates;
      EXPECT_LT(found.sigma[g], 3e-3 * known_values[g]);
    }
    EXPECT_GT(found.equations, 100);
  }
}

// Values within three standard deviations, and those of many seeds as wide as is told.
TEST(Identification, TellsHowWrongItIsUnderNoise) {
  for (const bool with_rates : {false, true}) {
    const RodMotionRecord exact = step_response(true_tentacle(nominal_tentacle(), {}), with_rates);
    TestRandom random(case_seed(with_rates ? 1 : 0));
    const int seeds = 16;
    Eigen::Vector4d squares = Eigen::Vector4d::Zero(), sum = Eigen::Vector4d::Zero();
    double mahalanobis = 0, misfit = 0;
    for (int seed = 0; seed < seeds; ++seed) {
      const Identification found =
          identify(nominal_tentacle(), all_of_it, noisy(exact, with_rates ? 0.02 : 0.005, 0.2, random));
      const Eigen::Vector4d error = found.values - known_values;
      const Eigen::Vector4d parts = error.cwiseQuotient(found.sigma);
      EXPECT_LT(parts.cwiseAbs().maxCoeff(), 4);
      if (seed == 0) {
        EXPECT_LT(parts.cwiseAbs().maxCoeff(), 3);
      }
      EXPECT_LT(found.sigma.cwiseQuotient(known_values).maxCoeff(), 0.05);
      squares += parts.cwiseAbs2() / seeds;
      sum += parts / seeds;
      mahalanobis += error.dot(found.covariance.ldlt().solve(error)) / seeds;
      misfit += found.misfit / seeds;
    }
    // Of 16 seeds the mean square is 1 +- 0.35, the mean 0 +- 0.25, the mean of the distance 4 +- 0.7.
    EXPECT_GT(squares.minCoeff(), 0.3);
    EXPECT_LT(squares.maxCoeff(), 2.4);
    EXPECT_LT(sum.cwiseAbs().maxCoeff(), 0.9);
    EXPECT_NEAR(mahalanobis, 4, 2.5);
    EXPECT_NEAR(misfit, 1, 0.1);
  }
}

// In a plane nothing twists, and the rod's stiffness against it is not seen.
TEST(Identification, FlagsWhatTheRecordDoesNotTell) {
  const Rod nominal = nominal_tentacle({.shear = 0, .stretch = 0, .bend = 2, .twist = 1});
  const RodLoads down{.gravity = {-9.81, 0, 0}};
  const RodMotionRecord exact =
      step_response(true_tentacle(nominal, {}), false, down, {4, 0, 0, 3, 0, 0}, {1, 0, 0, 5, 0, 0});
  std::vector<RodParameter> parameters = all_of_it;
  parameters.push_back({.kind = Kind::twist});
  parameters.push_back({.kind = Kind::shear});
  TestRandom random(case_seed(0));
  for (const bool is_noisy : {false, true}) {
    const Identification found =
        identify(nominal, parameters, is_noisy ? noisy(exact, 0.005, 0, random) : exact);
    EXPECT_TRUE(found.values.allFinite());
    EXPECT_TRUE(found.covariance.allFinite());
    for (const std::size_t g : {4u, 5u}) {
      EXPECT_FALSE(found.is_observable[g]) << is_noisy << g;
      EXPECT_TRUE(std::isinf(found.sigma[static_cast<Eigen::Index>(g)]));
      EXPECT_EQ(found.values[static_cast<Eigen::Index>(g)], 1);
    }
    for (std::size_t g = 0; g < 4; ++g) {
      const auto at = static_cast<Eigen::Index>(g);
      EXPECT_TRUE(found.is_observable[g]) << is_noisy << g;
      EXPECT_NEAR(found.values[at], known_values[at],
                  is_noisy ? 4 * found.sigma[at] : 5e-3 * known_values[at]);
    }
  }
}

// Left to itself without weight a rod tells ratios alone: mass, stiffness and damping by one factor.
TEST(Identification, FlagsFactorsThatOnlyTheirRatiosTell) {
  const Rod truth = true_tentacle(nominal_tentacle(), {});
  RodDynamics dynamics(truth, {.spectral_radius = 1});
  RodState state = dynamics.start(Eigen::VectorXd::Constant(8, 1.0), Eigen::VectorXd::Zero(8), {}, {});
  RodMotionRecord record;
  for (int k = 0; k < 250; ++k) {
    record.samples.push_back({.time = state.time, .q = state.q});
    for (int i = 0; i < 8; ++i) ASSERT_TRUE(dynamics.step(state, {}, {}, sample_time / 8).converged());
  }
  const Identification all = identify(nominal_tentacle(), all_of_it, record);
  EXPECT_TRUE(all.values.allFinite());
  for (std::size_t g = 0; g < 4; ++g) {
    EXPECT_FALSE(all.is_observable[g]);
    EXPECT_TRUE(std::isinf(all.sigma[static_cast<Eigen::Index>(g)]));
  }
  // With the mass believed the others are known by it.
  const Identification some = identify(nominal_tentacle(), {all_of_it.begin(), all_of_it.end() - 1}, record);
  for (Eigen::Index g = 0; g < 3; ++g)
    EXPECT_NEAR(some.values[g], known_values[g] / 1.1, 3e-3 * known_values[g]);
}

TEST(Identification, OfARodThatDoesNotMoveNothingIsKnown) {
  RodMotionRecord record;
  for (int k = 0; k < 100; ++k) record.samples.push_back({.time = 0.01 * k, .q = Eigen::VectorXd::Zero(8)});
  const Identification found = identify(nominal_tentacle(), all_of_it, record);
  EXPECT_TRUE(found.values.allFinite());
  for (std::size_t g = 0; g < 4; ++g) EXPECT_FALSE(found.is_observable[g]);
  record.q_noise = Eigen::VectorXd::Constant(8, 0.01);
  EXPECT_TRUE(identify(nominal_tentacle(), all_of_it, record).values.allFinite());
}

TEST(Identification, RefusesWhatIsNoRecord) {
  const Rod rod = nominal_tentacle();
  RodMotionRecord record;
  for (int k = 0; k < 100; ++k)
    record.samples.push_back({.time = 0.01 * k, .q = Eigen::VectorXd::Constant(8, 0.1 * k)});
  const auto refuses = [&](const RodMotionRecord& bad,
                           const std::vector<RodParameter>& parameters = all_of_it,
                           const IdentificationConfig& config = {}) {
    EXPECT_THROW((void)identify(rod, parameters, bad, config), std::invalid_argument);
  };
  refuses(record, {});
  refuses(record, {{.kind = Kind::bends}, {.kind = Kind::bends, .section = 1}});
  refuses(record, {{.kind = Kind::mass}, {.kind = Kind::mass}});
  refuses(record, {{.kind = Kind::mass, .section = 0}});
  refuses(record, {{.kind = Kind::bends, .section = 2}});
  refuses(record, all_of_it, {.window = 5});
  refuses(record, all_of_it, {.window = -1});
  refuses(record, all_of_it, {.window = 0.02});
  RodMotionRecord bad = record;
  bad.samples.resize(10);
  refuses(bad);
  bad = record;
  bad.samples[5].time = 0.03;
  refuses(bad);
  bad = record;
  bad.samples[5].q[2] = std::nan("");
  refuses(bad);
  bad = record;
  bad.samples[5].v = record.samples[5].q;
  refuses(bad);
  bad = record;
  bad.samples[50].tensions = {-1, 0, 0, 0, 0, 0};
  refuses(bad);
  bad = record;
  bad.q_noise = Eigen::VectorXd::Constant(8, -1);
  refuses(bad);
  bad = record;
  bad.v_noise = Eigen::VectorXd::Constant(8, 1);
  refuses(bad);
}

}  // namespace
}  // namespace flexura
