#include "flexura/mechanics/place_record.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "flexura/mechanics/dynamics.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

// Two soft sections of different stiffness, and places along them.
Rod soft_pair(int twist = 1) {
  Rod rod = soft_arm(3e5, 2);
  rod.sections[0].modes.shear = 0;
  rod.sections[0].modes.twist = twist;
  rod.sections.push_back(rod.sections[0]);
  rod.tendons = {{.section = 1, .radius = 0.007, .angle = 0.4}};
  return rod;
}
std::vector<RodPlace> eight_places() {
  std::vector<RodPlace> places;
  for (std::size_t section = 0; section < 2; ++section)
    for (const double at : {0.25, 0.5, 0.75, 1.0}) places.push_back({section, at});
  return places;
}

// The rod falls to its side: its true places and modes.
struct Fall {
  std::vector<RodPlaceSample> samples;
  std::vector<Eigen::VectorXd> modes;
};
Fall fall(const Rod& rod, const RodLoads& loads) {
  RodDynamics dynamics(rod, {.spectral_radius = 1}, eight_places());
  RodState state = dynamics.rest();
  Fall result;
  for (int k = 0; k < 60; ++k) {
    RodPlaceSample sample{.time = state.time, .positions = {}, .tensions = {0.5}};
    for (const RodPlace& place : eight_places())
      sample.positions.push_back(dynamics.motion(state, place).pose.position);
    result.samples.push_back(sample);
    result.modes.push_back(state.q);
    for (int i = 0; i < 5; ++i)
      EXPECT_TRUE(dynamics.step(state, {.tensions = {0.5}}, loads, 2e-3).converged());
  }
  return result;
}

const RodLoads to_the_side{.gravity = {3, 5, -2}};

TEST(RecordOfPlaces, OfExactPlacesGivesTheModesBack) {
  const Rod rod = soft_pair();
  const Fall known = fall(rod, to_the_side);
  const RodPlaceRecord found = record_of_places(rod, eight_places(), known.samples, to_the_side);
  ASSERT_EQ(found.record.samples.size(), known.modes.size());
  const Eigen::VectorXd scales = RodChain(rod).scales();
  for (std::size_t k = 0; k < known.modes.size(); ++k) {
    const Eigen::VectorXd error = (found.record.samples[k].q - known.modes[k]).cwiseProduct(scales);
    // The twist of a nearly straight arm is hardly visible.
    EXPECT_LT(error.cwiseAbs().maxCoeff(), 2e-2) << k;
    EXPECT_EQ(found.record.samples[k].time, known.samples[k].time);
  }
  EXPECT_LT(found.rms, 1e-6);
  EXPECT_LT(places_missed(rod, eight_places(), known.samples, found), 5e-3);
}

TEST(RecordOfPlaces, TellsHowWrongTheModesAre) {
  const Rod rod = soft_pair(0);
  Fall known = fall(rod, to_the_side);
  TestRandom random(case_seed(0));
  const double noise = 2e-4;
  for (RodPlaceSample& sample : known.samples)
    for (Eigen::Vector3d& p : sample.positions)
      for (double& coordinate : p) coordinate += noise * normal_number(random);
  for (const bool is_known : {true, false}) {
    const RodPlaceRecord found =
        record_of_places(rod, eight_places(), known.samples, to_the_side, is_known ? noise : 0);
    EXPECT_NEAR(found.noise, noise, is_known ? 0 : 0.15 * noise);
    double square = 0;
    for (std::size_t k = 0; k < known.modes.size(); ++k) {
      const RodMotionRecordSample& sample = found.record.samples[k];
      const Eigen::VectorXd error = sample.q - known.modes[k];
      square += error.dot(sample.q_covariance.inverse() * error) / static_cast<double>(error.size());
    }
    // 60 times 10 errors: expected 1 +- 0.06.
    EXPECT_NEAR(square / 60, 1, 0.3);
  }
}

// A diagonal covariance gives the same result as noise per mode, and a section's stiffness is one number.
TEST(RecordOfPlaces, ItsCovariancesCountAsNoiseDoes) {
  const Rod rod = soft_pair(0);
  RodMotionRecord record =
      record_of_places(rod, eight_places(), fall(rod, to_the_side).samples, to_the_side).record;
  const Eigen::Index n = record.samples[0].q.size();
  const std::vector<RodParameter> parameters = {{.kind = RodParameter::Kind::stiffness, .section = 0},
                                                {.kind = RodParameter::Kind::stiffness, .section = 1},
                                                {.kind = RodParameter::Kind::damping}};
  for (RodMotionRecordSample& sample : record.samples)
    sample.q_covariance = Eigen::VectorXd::LinSpaced(n, 1e-6, 4e-6).asDiagonal();
  const IdentificationConfig config{.window = 0.2};
  const Identification found = identify(rod, parameters, record, config);
  RodMotionRecord by_noise = record;
  for (RodMotionRecordSample& sample : by_noise.samples) sample.q_covariance.resize(0, 0);
  by_noise.q_noise = Eigen::VectorXd::LinSpaced(n, 1e-6, 4e-6).cwiseSqrt();
  const Identification same = identify(rod, parameters, by_noise, config);
  for (Eigen::Index g = 0; g < 3; ++g) {
    EXPECT_NEAR(found.values[g], same.values[g], 1e-7 * same.values[g]);
    EXPECT_NEAR(found.sigma[g], same.sigma[g], 1e-6 * same.sigma[g]);
  }
  EXPECT_NEAR(found.values[0], 1, 0.02);
  EXPECT_NEAR(found.values[1], 1, 0.02);
  const auto refuses = [&](const RodMotionRecord& bad) {
    EXPECT_THROW((void)identify(rod, parameters, bad), std::invalid_argument);
  };
  RodMotionRecord bad = record;
  bad.q_noise = by_noise.q_noise;
  refuses(bad);
  bad = record;
  bad.samples[7].q_covariance.resize(0, 0);
  refuses(bad);
  bad = record;
  bad.samples[7].q_covariance(0, 0) = -1;
  refuses(bad);
  bad.samples[7].q_covariance = Eigen::MatrixXd::Identity(2, 2);
  refuses(bad);
}

TEST(RecordOfPlaces, RefusesWhatIsNoRecord) {
  const Rod rod = soft_pair();
  const Fall known = fall(rod, to_the_side);
  const auto refuses = [&](const std::vector<RodPlace>& places, const std::vector<RodPlaceSample>& samples,
                           double noise = 0) {
    EXPECT_THROW((void)record_of_places(rod, places, samples, to_the_side, noise), std::invalid_argument);
  };
  refuses(eight_places(), {});
  refuses(eight_places(), known.samples, -1);
  refuses(eight_places(), known.samples, std::nan(""));
  std::vector<RodPlace> places = eight_places();
  places[0].section = 2;
  refuses(places, known.samples);
  places = eight_places();
  places[1] = places[0];
  refuses(places, known.samples);
  places.resize(2);
  refuses(places, known.samples);
  std::vector<RodPlaceSample> samples = known.samples;
  samples[3].positions.pop_back();
  refuses(eight_places(), samples);
  samples = known.samples;
  samples[3].positions[0].x() = std::nan("");
  refuses(eight_places(), samples);
  // Places of something ten times as large.
  samples = known.samples;
  for (RodPlaceSample& sample : samples)
    for (Eigen::Vector3d& p : sample.positions) p *= 10;
  refuses(eight_places(), samples);
}

}  // namespace
}  // namespace flexura
