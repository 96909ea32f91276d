// An arm observed repeatedly by cameras with errors of rotation and zoom.
#include "flexura/estimate/shape_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <vector>

#include "flexura/estimate/shape_estimator.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"
#include "tests/support/wrong_cameras.h"

namespace flexura {
namespace {

// The same arm, observed repeatedly by cameras whose views have priors.
TEST(ShapeTracker, KnowsMoreWithEveryObservation) {
  double once = 0, tracked = 0;
  for_random_cases(20, [&](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    ArmState state = random_bends(random, prior.arm, 1.5);
    const WrongCameras first = wrong_cameras(Backbone(prior.arm, state), random, 0.2);
    ShapeTracker tracker(prior, {});
    ShapeEstimator alone(prior);
    std::optional<ArmState> expected;
    for (int k = 0; k < 40; ++k) {
      ArmState given = state;
      for (Eigen::Vector2d& bend : state.bends) bend += random.vector<2>(-0.02, 0.02);
      const Backbone truth(prior.arm, state);
      std::vector<Observation> seen = observations_of(truth, random, 0.2);
      for (std::size_t i = 0; i < 2; ++i) {
        for (auto& end : seen[i].ends) end->pixel += 0.1 * random.vector<2>(-1.7, 1.7), end->sigma = 0.1;
        seen[i].view = first.seen[i].view, seen[i].view_prior = a_degree_and_two_percent;
      }
      // As drives report it: the motion of each section, to a hundredth.
      if (expected)
        for (std::size_t i = 0; i < 3; ++i) expected->bends[i] += 0.99 * (state.bends[i] - given.bends[i]);
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

// Errors correlated along an axis, independent between pictures: an arm at rest is known better with every
// picture, as much as is claimed.
TEST(ShapeTracker, KnowsHowMuchMoreItKnows) {
  constexpr double noise = 0.05, reach = 5.4;  // px
  double first_sigma = 0, last_sigma = 0, first_error = 0, last_error = 0;
  for_random_cases(30, [&](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const ArmState state = random_bends(random, prior.arm, 1.5);
    const Backbone truth(prior.arm, state);
    const WrongCameras cameras = wrong_cameras(truth, random, 0);
    ShapeTracker tracker(prior, {});
    std::optional<ArmState> expected;
    for (int k = 0; k < 100; ++k) {
      std::vector<Observation> seen = cameras.seen;
      for (Observation& one : seen) {
        one.reach.sigma = reach;
        for (auto& end : one.ends) end->pixel += 0.1 * random.vector<2>(-1.7, 1.7), end->sigma = 0.1;
        Eigen::Vector2d off = noise * random.vector<2>(-1.7, 1.7), before = one.points[0].pixel;
        for (CurvePoint& point : one.points) {
          const double alike = std::exp(-(point.pixel - before).norm() / reach);
          before = point.pixel;
          off = alike * off + std::sqrt(1 - alike * alike) * noise * random.vector<2>(-1.7, 1.7);
          point.pixel += off, point.sigma = noise;
        }
      }
      const ShapeEstimate found = tracker.look(seen, k / 30.0, expected);
      ASSERT_TRUE(found.is_found) << found.reason;
      expected = found.shape.state;
      double variance = 0;
      for (const double sigma : found.sigma)
        variance += sigma * sigma / static_cast<double>(found.sigma.size());
      const double error = std::pow(shape_error(found.shape, truth), 2);
      if (k == 0) first_sigma += variance, first_error += error;
      if (k == 99) last_sigma += variance, last_error += error;
    }
  });
  std::printf("claimed %.2g at first and %.2g after 100 pictures, wrong by %.2g and %.2g\n",
              std::sqrt(first_sigma / 30), std::sqrt(last_sigma / 30), std::sqrt(first_error / 30),
              std::sqrt(last_error / 30));
  EXPECT_LT(last_sigma, 0.25 * first_sigma);
  EXPECT_LT(last_error, 0.25 * first_error);
  EXPECT_LT(last_error, 2 * last_sigma);
  EXPECT_GT(last_error, 0.2 * last_sigma);
}

// An arm far from its prediction is found where it is.
TEST(ShapeTracker, GivesUpWhatTheObservationsSpeakAgainst) {
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
    const ShapeEstimate found = tracker.look(wrong_cameras(truth, random, 0.02, 0).seen, 11 / 30.0, expected);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LT(shape_error(found.shape, truth), 1e-3);
  });
}

// A fit that treats contradictions as outliers does not persist: after some observations a new estimate shows
// that the arm is elsewhere.
TEST(ShapeTracker, FindsOutThatACameraIsWrongFarBeyondDoubt) {
  int named = 0;
  for_random_cases(20, [&](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const ArmState state = random_bends(random, prior.arm, 1.5);
    const Backbone truth(prior.arm, state);
    std::vector<Observation> seen = wrong_cameras(truth, random, 0.02, 0).seen;
    seen[1].view = corrected(seen[1].view, {.turn = Eigen::Vector3d::Zero(), .focal = 0.2});
    for (Observation& one : seen) one.view_prior = {.rotation_std = 0.02, .focal_std = 0.02};
    ShapeTracker tracker(prior, {});
    ArmState expected = state;
    for (Eigen::Vector2d& bend : expected.bends) bend += random.vector<2>(-0.2, 0.2);
    ShapeEstimate found;
    for (int k = 0; k < 30; ++k) {
      found = tracker.look(seen, k / 30.0, expected);
      if (found.is_found) expected = found.shape.state;
    }
    EXPECT_FALSE(found.is_found);
    EXPECT_NE(found.reason, "");
    if (found.is_elsewhere) named += one_case_of;
  });
  EXPECT_GE(named, 16);
}

TEST(ShapeTracker, ForgetsWhenTold) {
  // This many seeds are enough to distinguish a tracker that forgets from one that does not.
  constexpr std::uint64_t seeds = 10;
  int kept = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    TestRandom random(seed);
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone first(prior.arm, random_bends(random, prior.arm, 1.5)),
        second(prior.arm, random_bends(random, prior.arm, 1.5));
    const std::vector<Observation> before = wrong_cameras(first, random, 0.02).seen,
                                   seen = wrong_cameras(second, random, 0.02).seen;
    ShapeTracker fresh(prior, {}), used(prior, {}), keeps(prior, {});
    (void)used.look(before, 0, std::nullopt);
    (void)keeps.look(before, 0, std::nullopt);
    used.forget();
    const ArmState expected = random_bends(random, prior.arm, 1.5);
    const auto alone = fresh.look(seen, 1, expected).shape.state.bends;
    EXPECT_EQ(used.look(seen, 1, expected).shape.state.bends, alone) << seed;
    if (keeps.look(seen, 1, expected).shape.state.bends != alone) ++kept;
  }
  EXPECT_GT(kept, 0);
}

TEST(ShapeTracker, LeavesAloneWhatIsNotDoubted) {
  for_random_cases(5, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    ArmState state = random_bends(random, prior.arm, 1.5);
    ShapeTracker tracker(prior, {});
    std::optional<ArmState> expected;
    for (int k = 0; k < 30; ++k) {
      WrongCameras cameras = wrong_cameras(Backbone(prior.arm, state), random, 0.05);
      for (Observation& one : cameras.seen) one.view_prior = {.rotation_std = 0.02, .focal_std = 0};
      const ShapeEstimate found = tracker.look(cameras.seen, k, expected);
      for (const ViewError& error : found.shape.views) EXPECT_LT(std::abs(error.focal), 1e-4);
      expected = found.shape.state;
    }
  });
}

// A few outlier points are ignored: the other picture determines the shape.
TEST(ShapeTracker, PassesOverAFewPointsOfSomethingElse) {
  for_random_cases(20, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone truth(prior.arm, random_bends(random, prior.arm, 0.8));
    std::vector<Observation> seen = wrong_cameras(truth, random, 0.02, 0).seen;
    for (Observation& one : seen) one.view_prior = {};
    ShapeTracker tracker(prior, {});
    const ArmState expected = tracker.look(seen, 0, std::nullopt).shape.state;
    seen[1].points.clear(), seen[1].ends = {};
    for (int k = 0; k < 6; ++k) seen[1].points.push_back({{100.0 + k, 60}, 0.05});
    const ShapeEstimate found = tracker.look(seen, 0.03, expected);
    EXPECT_TRUE(found.is_found) << found.reason;
    EXPECT_LT(shape_error(found.shape, truth), 0.01);
  });
}

TEST(ShapeTracker, NeedsAnArmWhoseLengthIsKnown) {
  EXPECT_THROW(ShapeTracker({.arm = three_section_arm(), .is_length_known = false}, {}),
               std::invalid_argument);
}

// A short false axis in one picture: the other picture alone would determine the shape.
TEST(ShapeTracker, RefusesAnAxisOfSomethingElse) {
  for_random_cases(20, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const ArmState state = random_bends(random, prior.arm, 1.5);
    std::vector<Observation> seen = wrong_cameras(Backbone(prior.arm, state), random, 0.02, 0).seen;
    ShapeTracker tracker(prior, {});
    ArmState expected = tracker.look(seen, 0, std::nullopt).shape.state;
    for (Eigen::Vector2d& bend : expected.bends) bend += random.vector<2>(-0.1, 0.1);
    seen[1].points.clear(), seen[1].ends = {};
    for (int k = 0; k < 10; ++k) seen[1].points.push_back({{100.0 + k, 60}, 0.05});
    const ShapeEstimate none = tracker.look(seen, 0.03, expected);
    EXPECT_FALSE(none.is_found);
    EXPECT_NE(none.reason, "");
  });
}

}  // namespace
}  // namespace flexura
