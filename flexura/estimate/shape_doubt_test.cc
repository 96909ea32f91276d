// Cameras that are turned and zoomed otherwise than believed: their errors are found with the shape.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
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
    const ViewError believed{random.vector<3>(-0.5, 0.5) * most * one_degree,
                             random.uniform(-0.01, 0.01) * most};
    const View is = one.view;
    one.view = corrected(is, believed);
    one.doubt = doubt;
    cameras.errors.push_back(
        {so3_log(one.view.X_WC.rotation.transpose() * is.X_WC.rotation), -believed.focal});
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
        for (std::size_t i = 0; i < 3; ++i) expected->bends[i] += 0.99 * (state.bends[i] - told.bends[i]);
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

// Errors that go together along an axis, from picture to picture others: an arm that stands still is known
// better the longer it is looked at, as much better as is claimed.
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
      std::vector<Sighting> seen = cameras.seen;
      for (Sighting& one : seen) {
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
    const ShapeEstimate found = tracker.look(wrong_cameras(truth, random, 0.02, 0).seen, 11 / 30.0, expected);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LT(shape_error(found.shape, truth), 1e-3);
  });
}

TEST(ShapeTracker, ForgetsWhenTold) {
  // Of so many seeds some tell a tracker that forgets from one that does not.
  constexpr std::uint64_t seeds = 10;
  int kept = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    TestRandom random(seed);
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone first(prior.arm, random_bends(random, prior.arm, 1.5)),
        second(prior.arm, random_bends(random, prior.arm, 1.5));
    const std::vector<Sighting> before = wrong_cameras(first, random, 0.02).seen,
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
      for (Sighting& one : cameras.seen) one.doubt = {.turn = 0.02, .focal = 0};
      const ShapeEstimate found = tracker.look(cameras.seen, k, expected);
      for (const ViewError& error : found.shape.views) EXPECT_LT(std::abs(error.focal), 1e-4);
      expected = found.shape.state;
    }
  });
}

TEST(ShapeTracker, NeedsAnArmWhoseLengthIsKnown) {
  EXPECT_THROW(ShapeTracker({.arm = three_section_arm(), .is_length_known = false}, {}),
               std::invalid_argument);
}

// The border of a straight or bent tube about its backbone's image, of three_section_arm's radius.
std::vector<SeenBorder> borders_of(const Backbone& backbone, const View& view) {
  std::vector<SeenBorder> borders;
  constexpr int count = 30;
  for (const double side : {-1.0, 1.0}) {
    for (int k = 0; k <= count; ++k) {
      const Pose X_WS = backbone.pose(backbone.length() * k / count);
      const Eigen::Vector3d sight = (X_WS.position - view.X_WC.position).normalized(),
                            across = sight.cross(X_WS.rotation.col(2)).normalized();
      borders.push_back({view.project(X_WS.position + side * 0.02 * across).value()});
    }
  }
  return borders;
}

// A picture without an axis: its silhouette's border counts, if it is the arm's.
TEST(ShapeFromABorder, IsFollowed) {
  for_random_cases(20, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    ArmState state = random_bends(random, prior.arm, 0.8);
    ShapeTracker tracker(prior, {});
    std::optional<ArmState> expected;
    for (int k = 0; k < 12; ++k) {
      if (k >= 4)
        for (Eigen::Vector2d& bend : state.bends) bend += random.vector<2>(-0.02, 0.02);
      const Backbone truth(prior.arm, state);
      std::vector<Sighting> seen = wrong_cameras(truth, random, 0.02, 0).seen;
      if (k >= 4) {
        seen[1].borders = borders_of(truth, two_views()[1]);
        seen[1].points.clear(), seen[1].ends = {};
      }
      const ShapeEstimate found = tracker.look(seen, k / 30.0, expected);
      ASSERT_TRUE(found.is_found) << found.reason;
      EXPECT_LT(shape_error(found.shape, truth), 1e-2) << k;
      expected = found.shape.state;
    }
  });
}

std::vector<SeenBorder> disc(double radius) {
  std::vector<SeenBorder> borders;
  for (int k = 0; k < 40; ++k) {
    const double angle = 2 * std::numbers::pi * k / 40;
    borders.push_back({{320 + radius * std::cos(angle), 240 + radius * std::sin(angle)}});
  }
  return borders;
}

TEST(ShapeFromABorder, IsNoneWhereItIsOfSomethingElse) {
  for (const double radius : {12.0, 40.0}) {
    for_random_cases(12, [&](TestRandom& random) {
      const ShapePrior prior{.arm = three_section_arm()};
      const ArmState state = random_bends(random, prior.arm, 1.5);
      const Backbone truth(prior.arm, state);
      std::vector<Sighting> seen = wrong_cameras(truth, random, 0.02, 0).seen;
      ShapeTracker tracker(prior, {});
      const std::optional<ArmState> expected = tracker.look(seen, 0, std::nullopt).shape.state;
      seen[1].borders = disc(radius), seen[1].points.clear(), seen[1].ends = {};
      const ShapeEstimate none = tracker.look(seen, 0.03, expected);
      EXPECT_FALSE(none.is_found);
      EXPECT_NE(none.reason, "the arm is not seen in every image");
      EXPECT_FALSE(ShapeEstimator(prior).estimate(seen).is_found);
      EXPECT_FALSE(ShapeEstimator(unknown_arm(Eigen::Vector3d::Zero(), 1)).estimate(seen).is_found);
      seen[1].borders.clear();
      EXPECT_FALSE(tracker.look(seen, 0.06, expected).is_found);
    });
  }
}

// Magnified until a thin arm's width is less than the way between the places along it at which it is looked
// for.
TEST(ShapeFromABorder, IsFollowedOfAThinArmInALargePicture) {
  for_random_cases(8, [](TestRandom& random) {
    ShapePrior prior{.arm = three_section_arm()};
    for (Section& section : prior.arm.sections) section.radius = {0.002, 0.002};
    const ArmState state = random_bends(random, prior.arm, 0.8);
    const Backbone truth(prior.arm, state);
    std::vector<Sighting> seen;
    for (View view : two_views()) {
      Intrinsics lens = view.lens.intrinsics();
      for (double* value : {&lens.fx, &lens.fy, &lens.cx, &lens.cy}) *value *= 8;
      view.lens = Lens(lens), view.width *= 8, view.height *= 8;
      seen.push_back(sighting_of(truth, view, random, 0.02));
    }
    ShapeTracker tracker(prior, {});
    const ShapeEstimate first = tracker.look(seen, 0, std::nullopt);
    ASSERT_TRUE(first.is_found) << first.reason;
    constexpr int count = 150;
    const View view = seen[1].view;
    for (const double side : {-1.0, 1.0}) {
      for (int k = 0; k <= count; ++k) {
        const Pose X_WS = truth.pose(truth.length() * k / count);
        const Eigen::Vector3d sight = (X_WS.position - view.X_WC.position).normalized(),
                              across = sight.cross(X_WS.rotation.col(2)).normalized();
        seen[1].borders.push_back({view.project(X_WS.position + side * 0.002 * across).value()});
      }
    }
    seen[1].points.clear(), seen[1].ends = {};
    const ShapeEstimate found = tracker.look(seen, 0.03, first.shape.state);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LT(shape_error(found.shape, truth), 1e-2);
  });
}

TEST(ShapeFromABorder, LeavesOutWhatIsNoPoint) {
  TestRandom random(1);
  const ShapePrior prior{.arm = three_section_arm()};
  const Backbone truth(prior.arm, random_bends(random, prior.arm, 0.8));
  std::vector<Sighting> seen = wrong_cameras(truth, random, 0.02, 0).seen;
  ShapeTracker tracker(prior, {});
  const ArmState expected = tracker.look(seen, 0, std::nullopt).shape.state;
  seen[1].borders = borders_of(truth, two_views()[1]);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  seen[1].borders[3].pixel.x() = nan, seen[1].borders[7].sigma = 0, seen[0].points[2].pixel.y() = nan;
  seen[1].points.clear(), seen[1].ends = {};
  const ShapeEstimate found = tracker.look(seen, 0.03, expected);
  ASSERT_TRUE(found.is_found) << found.reason;
  EXPECT_LT(shape_error(found.shape, truth), 1e-2);
}

TEST(ShapeEstimator, FindsNothingWhereNothingIsSeen) {
  const ShapePrior prior{.arm = three_section_arm()};
  const Shape straight{prior.arm, ArmState::straight(prior.arm.sections.size()), {}};
  ShapeEstimator estimator(prior);
  const ShapeVariables variables(prior);
  const ShapeBelief belief{straight, Eigen::MatrixXd::Identity(variables.count(), variables.count())};
  for (const ShapeEstimate& none :
       {estimator.estimate({}), estimator.follow({}, straight), estimator.update({}, belief)}) {
    EXPECT_FALSE(none.is_found);
    EXPECT_EQ(none.reason, "the arm is not seen in every image");
  }
}

// A short axis of something else in one picture: the other one alone would tell the shape.
TEST(ShapeTracker, RefusesAnAxisOfSomethingElse) {
  for_random_cases(20, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const ArmState state = random_bends(random, prior.arm, 1.5);
    std::vector<Sighting> seen = wrong_cameras(Backbone(prior.arm, state), random, 0.02, 0).seen;
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

// Something before the base in one picture: where the arm comes out is no base.
TEST(ShapeWithDoubtfulViews, AreNotTurnedToWhereTheArmComesOut) {
  for_random_cases(40, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone truth(prior.arm, random_bends(random, prior.arm, 1.5));
    std::vector<Sighting> seen = wrong_cameras(truth, random, 0.02, 0).seen;
    Sighting& hidden = seen[1];
    hidden = sighting_of(truth, two_views()[1], random, 0.02, {random.uniform(0.03, 0.25), 1});
    hidden.doubt = doubt, hidden.ends[0] = SeenEnd{hidden.points.front().pixel};
    const ShapeEstimate found = ShapeEstimator(prior).estimate(seen);
    if (!found.is_found) return;
    EXPECT_LT(shape_error(found.shape, truth), 0.02) << found.notes.size();
    EXPECT_FALSE(found.notes.empty());
  });
}

}  // namespace
}  // namespace flexura
