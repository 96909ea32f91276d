// Cameras with errors of rotation and zoom: these are estimated with the shape.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/shape_fit.h"
#include "flexura/estimate/shape_tracker.h"
#include "tests/support/mahalanobis.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"
#include "tests/support/wrong_cameras.h"

namespace flexura {
namespace {

TEST(ShapeWithViewPriors, IsFoundWithTheErrorsOfTheViews) {
  for_random_cases(100, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone truth(prior.arm, random_bends(random, prior.arm, 1.5));
    const WrongCameras cameras = wrong_cameras(truth, random, 0);
    ShapeEstimator estimator(prior);
    const ShapeEstimate found = estimator.estimate(cameras.seen);
    ASSERT_TRUE(found.is_found) << found.reason;
    // The priors pull the errors towards zero, against ends with 0.1 px.
    EXPECT_LT(shape_error(found.shape, truth), 5e-4);
    ASSERT_EQ(found.shape.views.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LT((found.shape.views[i].turn - cameras.errors[i].turn).norm(), 0.05 * degree);
      EXPECT_NEAR(found.shape.views[i].focal, cameras.errors[i].focal, 2e-3);
    }
  });
}

// Pictures of two different shapes: a poor fit gives no information on the cameras.
TEST(ShapeWithViewPriors, SaysHowACameraStandsOnlyWhereThatExplainsThePictures) {
  int omitted = 0;
  for_random_cases(24, [&](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const auto look = [&] {
      return wrong_cameras(Backbone(prior.arm, random_bends(random, prior.arm, 1.8)), random, 0.02).seen;
    };
    std::vector<Observation> seen = look();
    seen[1] = look()[1];
    const ShapeEstimate none = ShapeEstimator(prior).estimate(seen);
    const bool explains_little = none.outlier_share >= 0.1 || none.scale >= ShapeFit::most_scale;
    const bool is_said = none.reason.find("fits only if its camera is rotated") != std::string::npos;
    EXPECT_EQ(none.is_elsewhere, is_said);
    EXPECT_FALSE(is_said && explains_little) << none.reason;
    if (none.reason.starts_with("the pictures require camera errors far beyond")) ++omitted;
  });
  EXPECT_GT(omitted * one_case_of, 3);
}

// Errors of bends and views together, normalised by the covariance.
TEST(ShapeWithViewPriors, IsWithinItsOwnSigmas) {
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
    const Eigen::VectorXd off = variables.minus(found.shape, {prior.arm, state, cameras.errors});
    squares += mahalanobis_square(found.covariance, off), count += static_cast<int>(off.size());
  });
  EXPECT_GT(squares, 0.5 * count);
  EXPECT_LT(squares, 1.5 * count);
}

// The border of a straight or bent tube about its backbone's image, with three_section_arm's radius.
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

// A picture without an axis: its silhouette's border is used if it fits the arm.
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
      std::vector<Observation> seen = wrong_cameras(truth, random, 0.02, 0).seen;
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
      std::vector<Observation> seen = wrong_cameras(truth, random, 0.02, 0).seen;
      ShapeTracker tracker(prior, {});
      const std::optional<ArmState> expected = tracker.look(seen, 0, std::nullopt).shape.state;
      seen[1].borders = disc(radius), seen[1].points.clear(), seen[1].ends = {};
      const ShapeEstimate none = tracker.look(seen, 0.03, expected);
      EXPECT_FALSE(none.is_found);
      EXPECT_NE(none.reason, "the arm is not visible in every image");
      EXPECT_FALSE(ShapeEstimator(prior).estimate(seen).is_found);
      EXPECT_FALSE(ShapeEstimator(unknown_arm(Eigen::Vector3d::Zero(), 1)).estimate(seen).is_found);
      seen[1].borders.clear();
      EXPECT_FALSE(tracker.look(seen, 0.06, expected).is_found);
    });
  }
}

// Magnified until a thin arm's width is less than the distance of the sample points along it.
TEST(ShapeFromABorder, IsFollowedOfAThinArmInALargePicture) {
  for_random_cases(8, [](TestRandom& random) {
    ShapePrior prior{.arm = three_section_arm()};
    for (Section& section : prior.arm.sections) section.radius = {0.002, 0.002};
    const ArmState state = random_bends(random, prior.arm, 0.8);
    const Backbone truth(prior.arm, state);
    std::vector<Observation> seen;
    for (View view : two_views()) {
      Intrinsics lens = view.lens.intrinsics();
      for (double* value : {&lens.fx, &lens.fy, &lens.cx, &lens.cy}) *value *= 8;
      view.lens = Lens(lens), view.width *= 8, view.height *= 8;
      seen.push_back(observation_of(truth, view, random, 0.02));
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
  std::vector<Observation> seen = wrong_cameras(truth, random, 0.02, 0).seen;
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
  const ShapePrediction prediction{straight, Eigen::MatrixXd::Identity(variables.count(), variables.count())};
  for (const ShapeEstimate& none :
       {estimator.estimate({}), estimator.follow({}, straight), estimator.update({}, prediction)}) {
    EXPECT_FALSE(none.is_found);
    EXPECT_EQ(none.reason, "the arm is not visible in every image");
  }
}

// Something covers the base in one picture: where the arm emerges is not the base.
TEST(ShapeWithViewPriors, AreNotTurnedToWhereTheArmComesOut) {
  int count = 0;
  for_random_cases(40, [&](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone truth(prior.arm, random_bends(random, prior.arm, 1.5));
    std::vector<Observation> seen = wrong_cameras(truth, random, 0.02, 0).seen;
    Observation& hidden = seen[1];
    hidden = observation_of(truth, two_views()[1], random, 0.02, {random.uniform(0.03, 0.25), 1});
    hidden.view_prior = a_degree_and_two_percent, hidden.ends[0] = SeenEnd{hidden.points.front().pixel};
    const ShapeEstimate found = ShapeEstimator(prior).estimate(seen);
    if (!found.is_found) return;
    ++count;
    EXPECT_LT(shape_error(found.shape, truth), 0.02) << found.notes.size();
    EXPECT_FALSE(found.notes.empty());
  });
  EXPECT_GT(count, 30 / one_case_of);
}

}  // namespace
}  // namespace flexura
