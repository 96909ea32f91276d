// Cameras that are turned and zoomed otherwise than believed: their errors are found with the shape.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/shape_tracker.h"
#include "flexura/math/so3.h"
#include "tests/support/random_cases.h"
#include "tests/support/sightings.h"

namespace flexura {
namespace {

constexpr double one_degree = std::numbers::pi / 180;
constexpr ViewDoubt doubt = {.turn = 1 * one_degree, .focal = 0.02};

struct WrongCameras {
  std::vector<Sighting> seen;
  std::vector<ViewError> errors;
};

// What both cameras see, which are believed to be `most` of half a degree and 1 % otherwise.
WrongCameras wrong_cameras(const Backbone& truth, TestRandom& random, double noise, double most = 1) {
  WrongCameras cameras{sightings_of(truth, random, noise), {}};
  for (Sighting& one : cameras.seen) {
    for (auto& end : one.ends) end->sigma = 0.1;
    const ViewError believed{random.vector<3>(-0.5, 0.5) * most * one_degree, random.uniform(-0.01, 0.01) * most};
    const View is = one.view;
    one.view = corrected(is, believed);
    one.doubt = doubt;
    cameras.errors.push_back({so3_log(one.view.X_WC.rotation.transpose() * is.X_WC.rotation), -believed.focal});
  }
  return cameras;
}

TEST(ShapeWithDoubtfulViews, IsFoundWithTheErrorsOfTheViews) {
  for_random_cases(100, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone truth(prior.arm, random_bends(random, prior.arm, 1.5));
    const WrongCameras cameras = wrong_cameras(truth, random, 0);
    ShapeEstimator estimator(prior);
    const ShapeEstimate found = estimator.estimate(cameras.seen);
    ASSERT_TRUE(found.is_found) << found.reason;
    // The doubts draw the errors towards none, against what the ends say to a tenth of a pixel.
    EXPECT_LT(shape_error(found.shape, truth), 5e-4);
    ASSERT_EQ(found.shape.views.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LT((found.shape.views[i].turn - cameras.errors[i].turn).norm(), 0.05 * one_degree);
      EXPECT_NEAR(found.shape.views[i].focal, cameras.errors[i].focal, 2e-3);
    }
  });
}

TEST(ShapeWithDoubtfulViews, IsWrongWhereTheyAreBelieved) {
  std::vector<double> off;
  for_random_cases(20, [&](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone truth(prior.arm, random_bends(random, prior.arm, 1.5));
    WrongCameras cameras = wrong_cameras(truth, random, 0);
    for (Sighting& one : cameras.seen) one.doubt = {};
    EstimatorConfig patient;
    patient.most_rms = 20;
    ShapeEstimator estimator(prior, patient);
    off.push_back(shape_error(estimator.estimate(cameras.seen).shape, truth));
  });
  std::ranges::sort(off);
  EXPECT_GT(off[off.size() / 2], 5e-3);
}

// Errors of bends and views together, in units of what the covariance expects.
TEST(ShapeWithDoubtfulViews, IsWithinItsOwnSigmas) {
  double squares = 0;
  int count = 0;
  for_random_cases(100, [&](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const ArmState state = random_bends(random, prior.arm, 1.5);
    WrongCameras cameras = wrong_cameras(Backbone(prior.arm, state), random, 0.05);
    for (std::size_t i = 0; i < 2; ++i)
      for (auto& end : cameras.seen[i].ends) end->pixel += 0.1 * random.vector<2>(-1.7, 1.7);
    ShapeEstimator estimator(prior);
    const ShapeEstimate found = estimator.estimate(cameras.seen);
    ASSERT_TRUE(found.is_found) << found.reason;
    const ShapeVariables variables(prior, cameras.seen);
    const Eigen::VectorXd off = variables.between({prior.arm, state, cameras.errors}, found.shape);
    squares += off.dot(found.covariance.ldlt().solve(off)), count += static_cast<int>(off.size());
  });
  EXPECT_GT(squares, 0.5 * count);
  EXPECT_LT(squares, 1.5 * count);
}

// The same arm, seen again and again by cameras whose views are doubted.
TEST(ShapeTracker, KnowsMoreWithEverySighting) {
  double once = 0, tracked = 0;
  for_random_cases(20, [&](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    ArmState state = random_bends(random, prior.arm, 1.5);
    const WrongCameras first = wrong_cameras(Backbone(prior.arm, state), random, 0.2);
    ShapeTracker tracker(prior, {});
    ShapeEstimator alone(prior);
    std::optional<ArmState> expected;
    for (int k = 0; k < 40; ++k) {
      ArmState told = state;
      for (Eigen::Vector2d& bend : state.bends) bend += random.vector<2>(-0.02, 0.02);
      const Backbone truth(prior.arm, state);
      std::vector<Sighting> seen = sightings_of(truth, random, 0.2);
      for (std::size_t i = 0; i < 2; ++i) {
        for (auto& end : seen[i].ends) end->pixel += 0.1 * random.vector<2>(-1.7, 1.7), end->sigma = 0.1;
        seen[i].view = first.seen[i].view, seen[i].doubt = doubt;
      }
      // As drives tell: how far each section has gone, but for a hundredth.
      if (expected)
        for (std::size_t i = 0; i < 3; ++i)
          expected->bends[i] += 0.99 * (state.bends[i] - told.bends[i]);
      const ShapeEstimate found = tracker.look(seen, k / 30.0, expected);
      ASSERT_TRUE(found.is_found) << found.reason;
      expected = found.shape.state;
      if (k < 20) continue;
      once += std::pow(shape_error(alone.estimate(seen).shape, truth), 2);
      tracked += std::pow(shape_error(found.shape, truth), 2);
    }
  });
  EXPECT_LT(std::sqrt(tracked), 0.6 * std::sqrt(once));
}

// An arm that is where nobody expects it is seen where it is.
TEST(ShapeTracker, GivesUpWhatTheSightingsSpeakAgainst) {
  for_random_cases(20, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    ArmState state = random_bends(random, prior.arm, 1.5);
    ShapeTracker tracker(prior, {});
    std::optional<ArmState> expected;
    for (int k = 0; k < 10; ++k) {
      const WrongCameras cameras = wrong_cameras(Backbone(prior.arm, state), random, 0.02, 0);
      expected = tracker.look(cameras.seen, k / 30.0, expected).shape.state;
    }
    for (Eigen::Vector2d& bend : state.bends) bend += random.vector<2>(-0.5, 0.5);
    const Backbone truth(prior.arm, state);
    const ShapeEstimate found =
        tracker.look(wrong_cameras(truth, random, 0.02, 0).seen, 11 / 30.0, expected);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LT(shape_error(found.shape, truth), 1e-3);
  });
}

TEST(ShapeTracker, ForgetsWhenTold) {
  TestRandom random(1);
  const ShapePrior prior{.arm = three_section_arm()};
  const Backbone first(prior.arm, random_bends(random, prior.arm, 1.5)),
      second(prior.arm, random_bends(random, prior.arm, 1.5));
  const std::vector<Sighting> seen = wrong_cameras(second, random, 0.02).seen;
  ShapeTracker fresh(prior, {}), used(prior, {});
  (void)used.look(wrong_cameras(first, random, 0.02).seen, 0, std::nullopt);
  used.forget();
  const ArmState expected = random_bends(random, prior.arm, 1.5);
  EXPECT_EQ(used.look(seen, 1, expected).shape.state.bends, fresh.look(seen, 1, expected).shape.state.bends);
}

}  // namespace
}  // namespace flexura
