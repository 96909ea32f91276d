#include "flexura/estimate/shape_estimator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "tests/support/mahalanobis.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(ShapeEstimator, FindsAKnownArmExactlyWithoutNoise) {
  for_random_cases(60, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const ArmState state = random_bends(random, prior.arm, 1.8);
    const Backbone truth(prior.arm, state);
    ShapeEstimator estimator(prior);
    const ShapeEstimate found = estimator.estimate(observations_of(truth, random, 0));
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LT(shape_error(found.shape, truth), 1e-5);
    EXPECT_LT(found.outlier_share, 0.01);
  });
}

TEST(ShapeEstimator, IsWithinItsOwnSigmasUnderNoise) {
  int count = 0, within = 0;
  double worst = 0, squares = 0;
  for_random_cases(100, [&](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone truth(prior.arm, random_bends(random, prior.arm, 1.5));
    ShapeEstimator estimator(prior);
    const ShapeEstimate found = estimator.estimate(observations_of(truth, random, 0.05));
    ASSERT_TRUE(found.is_found) << found.reason;
    worst = std::max(worst, shape_error(found.shape, truth));
    const Backbone backbone(found.shape.arm, found.shape.state);
    for (const std::size_t i : {found.s.size() / 2, found.s.size() - 1}) {
      const double off =
          (backbone.pose(found.s[i]).position - truth.pose(std::min(found.s[i], truth.length())).position)
              .norm();
      ++count, within += off < 2 * found.sigma[i];
      squares += off * off / (found.sigma[i] * found.sigma[i]);
    }
  });
  // Two sigmas of three coordinates contain 85 to 97 %, depending on the direction of the errors.
  EXPECT_GT(within, 0.8 * count);
  // Far too large sigmas would satisfy the tests above easily.
  EXPECT_GT(squares, 0.4 * count);
  EXPECT_LT(squares, 1.6 * count);
  EXPECT_LT(worst, 3e-4);
}

// A series with standard deviation 1 and correlation length `reach`.
class Together {
 public:
  double next(TestRandom& random, double way, double reach) {
    const double alike = std::exp(-way / reach);
    value_ = is_first_ ? normal_number(random)
                       : alike * value_ + std::sqrt(1 - alike * alike) * normal_number(random);
    is_first_ = false;
    return value_;
  }

 private:
  double value_ = 0;
  bool is_first_ = true;
};

TEST(ShapeEstimator, IsWithinItsOwnSigmasWhereErrorsGoTogether) {
  constexpr double sigma = 0.03, offset = 0.02, reach = 8;
  double determined = 0, undetermined = 0, count = 0;
  for_random_cases(100, [&](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const ArmState state = random_bends(random, prior.arm, 1.5);
    std::vector<Observation> seen = observations_of(Backbone(prior.arm, state), random, 0);
    for (Observation& one : seen) {
      Together near, far;
      const std::vector<CurvePoint> exact = one.points;
      for (std::size_t i = 0; i + 1 < exact.size(); ++i) {
        const Eigen::Vector2d way = exact[i + 1].pixel - exact[i].pixel;
        const Eigen::Vector2d across = Eigen::Vector2d(-way.y(), way.x()).normalized();
        one.points[i].pixel += across * (sigma * near.next(random, way.norm(), reach) +
                                         offset * far.next(random, way.norm(), one.reach.offset));
        one.points[i].sigma = sigma, one.points[i].offset = offset;
      }
      one.points.pop_back();
      one.reach.sigma = reach;
    }
    const auto square_of = [&] {
      const ShapeEstimate found = ShapeEstimator(prior).estimate(seen);
      Eigen::VectorXd off(6);
      for (std::size_t i = 0; i < 3; ++i)
        off.segment<2>(static_cast<Eigen::Index>(2 * i)) = found.shape.state.bends[i] - state.bends[i];
      return mahalanobis_square(found.covariance, off);
    };
    determined += square_of(), count += 6;
    for (Observation& one : seen) {
      one.reach.sigma = 0;
      for (CurvePoint& point : one.points) point.offset = 0;
    }
    undetermined += square_of();
  });
  // The mean of chi^2 over its degrees of freedom, over 600: 1 to a sixteenth.
  EXPECT_GT(determined / count, 0.75);
  EXPECT_LT(determined / count, 1.25);
  EXPECT_GT(undetermined / count, 1.5);
}

TEST(ShapeEstimator, FindsAnArmOfUnknownMake) {
  for_random_cases(30, [](TestRandom& random) {
    const Arm arm = three_section_arm();
    const Backbone truth(arm, random_bends(random, arm, 1.2));
    ShapeEstimator estimator(unknown_arm(std::nullopt, std::nullopt));
    const ShapeEstimate found = estimator.estimate(observations_of(truth, random, 0.02));
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LT(shape_error(found.shape, truth), 2e-3);
    EXPECT_NEAR(Backbone(found.shape.arm, found.shape.state).length(), 1, 3e-3);
  });
}

TEST(ShapeEstimator, FollowsFromTheShapeBefore) {
  for_random_cases(30, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    ArmState state = random_bends(random, prior.arm, 1.5);
    ShapeEstimator estimator(prior);
    const Shape before{prior.arm, state};
    for (Eigen::Vector2d& bend : state.bends) bend += random.vector<2>(-0.05, 0.05);
    const Backbone truth(prior.arm, state);
    const ShapeEstimate found = estimator.follow(observations_of(truth, random, 0.02), before);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LT(shape_error(found.shape, truth), 1e-4);
    EXPECT_LE(found.iterations, 12);
  });
}

TEST(ShapeEstimator, HoldsAgainstPointsOfSomethingElse) {
  for_random_cases(30, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone truth(prior.arm, random_bends(random, prior.arm, 1.2));
    std::vector<Observation> seen = observations_of(truth, random, 0.03);
    for (Observation& one : seen)
      for (std::size_t i = 40; i < 50; ++i) one.points[i].pixel += Eigen::Vector2d(6, -5);
    ShapeEstimator estimator(prior);
    const ShapeEstimate found = estimator.estimate(seen);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LT(shape_error(found.shape, truth), 3e-4);
    EXPECT_GT(found.outlier_share, 0.03);
  });
}

TEST(ShapeEstimator, KnowsLessWhereTheArmIsCut) {
  for_random_cases(20, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone truth(prior.arm, random_bends(random, prior.arm, 1.0));
    std::vector<Observation> seen = observations_of(truth, random, 0.05);
    ShapeEstimator estimator(prior);
    const ShapeEstimate whole = estimator.estimate(seen);
    seen[1] = observation_of(truth, seen[1].view, random, 0.05, {0, 0.6});
    const ShapeEstimate cut = estimator.estimate(seen);
    ASSERT_TRUE(cut.is_found) << cut.reason;
    EXPECT_GT(cut.sigma.back(), 2 * whole.sigma.back());
    // A part seen by one camera only may bend towards it or away from it.
    EXPECT_FALSE(cut.notes.empty());
    EXPECT_LT(cut.rms, 0.1);
  });
}

// The last section is in neither picture: its bend is undetermined, up to the prior.
TEST(ShapeEstimator, DoesNotTellASectionThatNoPictureShows) {
  for_random_cases(40, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone truth(prior.arm, random_bends(random, prior.arm, 1.0));
    const double most = random.uniform(0.3, 0.66);
    std::vector<Observation> seen;
    for (const View& view : two_views())
      seen.push_back(observation_of(truth, view, random, 0.02, {0, random.uniform(0.5, 1) * most}));
    const ShapeEstimate found = ShapeEstimator(prior).estimate(seen);
    EXPECT_FALSE(found.is_found);
    EXPECT_FALSE(found.reason.empty());
  });
}

// An axis that stops short in both pictures, as at a tip that points away from them. The arm's length is then
// that of the visible part, however precise the estimate.
TEST(ShapeEstimator, TrustsNoLengthOfAnArmWhoseTipIsNowhereSeen) {
  for_random_cases(10, [](TestRandom& random) {
    const Arm arm = three_section_arm();
    const Backbone truth(arm, random_bends(random, arm, 1.0));
    const std::array<View, 2> views = two_views();
    const auto seen_to = [&](std::array<double, 2> shares) {
      return std::vector<Observation>{observation_of(truth, views[0], random, 0.02, {0, shares[0]}),
                                      observation_of(truth, views[1], random, 0.02, {0, shares[1]})};
    };
    const auto speaks_of_tip = [](const ShapeEstimate& found) {
      return std::ranges::any_of(
          found.notes, [](const std::string& note) { return note.find("the tip") != std::string::npos; });
    };
    // Notes on uncertainty alone are switched off.
    const EstimatorConfig sure{.uncertain = 1};
    const Eigen::Vector3d base = arm.X_WB.position;
    ShapeEstimator of_base(unknown_arm(base, {}), sure), of_length(unknown_arm(base, truth.length()), sure);
    const ShapeEstimate cut = of_base.estimate(seen_to({0.98, 0.98}));
    ASSERT_TRUE(cut.is_found) << cut.reason;
    EXPECT_GT(shape_error(cut.shape, truth), 1e-3);
    EXPECT_TRUE(speaks_of_tip(cut));
    EXPECT_FALSE(cut.is_trusted());
    // One picture of the tip is enough, and so is a known length.
    EXPECT_FALSE(speaks_of_tip(of_base.estimate(seen_to({1, 0.98}))));
    EXPECT_FALSE(speaks_of_tip(of_length.estimate(seen_to({0.98, 0.98}))));
    // Or a marker at a known position.
    std::vector<Observation> marked = seen_to({0.98, 0.98});
    for (Observation& one : marked)
      one.markers.push_back({one.view.project(truth.pose(0.5 * truth.length()).position).value(), 0.5, 0.1});
    EXPECT_FALSE(speaks_of_tip(of_base.estimate(marked)));
  });
}

TEST(ShapeEstimator, DoubtsOrRefusesWhatNoShapeExplains) {
  for_random_cases(6, [](TestRandom& random) {
    const ShapePrior prior{.arm = three_section_arm()};
    const Backbone one(prior.arm, random_bends(random, prior.arm, 1.0));
    std::vector<Observation> seen = observations_of(one, random, 0.02);
    // Notes on uncertainty alone are switched off.
    ShapeEstimator estimator(prior, {.uncertain = 1e-2});
    const ShapeEstimate right = estimator.estimate(seen);
    EXPECT_TRUE(right.is_found) << right.reason;
    EXPECT_TRUE(right.notes.empty()) << right.notes.front();
    // The second camera is elsewhere than modelled: no shape has both images.
    std::vector<Observation> moved = seen;
    for (CurvePoint& point : moved[1].points) point.pixel.y() += 60;
    for (auto& end : moved[1].ends) end->pixel.y() += 60;
    const ShapeEstimate wrong = estimator.estimate(moved);
    if (wrong.is_found) {
      EXPECT_FALSE(wrong.notes.empty()) << wrong.rms << " px, doubted " << wrong.outlier_share;
    } else {
      EXPECT_NE(wrong.reason, "");
    }
    // Nothing is visible.
    seen[1].points.clear();
    const ShapeEstimate none = estimator.estimate(seen);
    EXPECT_FALSE(none.is_found);
    EXPECT_EQ(none.reason, "the arm is not visible in every image");
  });
}

// If no picture shows the tip, the part beyond may be bent in different ways. Neither another shape that
// explains everything equally well nor one that the arm cannot take may be returned.
TEST(ShapeEstimator, IsNotSureOfAnotherShapeWhereNoPictureShowsTheTip) {
  int found = 0;
  for_random_cases(60, [&](TestRandom& random) {
    ShapePrior prior{.arm = three_section_arm()};
    for (Section& section : prior.arm.sections) section.max_bend = 2.97;
    const Backbone truth(prior.arm, random_bends(random, prior.arm, 2.9));
    std::vector<Observation> seen;
    for (const View& view : two_views())
      seen.push_back(observation_of(truth, view, random, 0.02, {0, random.uniform(0.6, 0.95)}));
    const ShapeEstimate estimate = ShapeEstimator(prior).estimate(seen);
    if (!estimate.is_found) return;
    ++found;
    const double error = shape_error(estimate.shape, truth);
    EXPECT_LT(error, 10 * estimate.rms_sigma() + 1e-3) << estimate.rms_sigma();
  });
  EXPECT_GT(found * one_case_of, 30);
}

// A lens whose described distortion folds back within the arm's picture.
TEST(ShapeEstimator, NamesThePictureThatItsLensShowsTheArmInNoPartOf) {
  TestRandom random(1);
  const ShapePrior prior{.arm = three_section_arm()};
  std::vector<Observation> seen =
      observations_of(Backbone(prior.arm, random_bends(random, prior.arm, 1)), random, 0.02);
  Intrinsics folded = seen[1].view.lens.intrinsics();
  folded.distortion[0] = -20;
  seen[1].view.lens = Lens(folded);
  const ShapeEstimate none = ShapeEstimator(prior).estimate(seen);
  EXPECT_FALSE(none.is_found);
  EXPECT_THAT(none.reason, testing::EndsWith("within the part of picture 2 for which its lens has rays: is "
                                             "its description of the distortion right?"));
}

// An arm that is described as stiffer than it is.
TEST(ShapeEstimator, SaysWhereASectionWouldBendFartherThanItGoes) {
  TestRandom random(1);
  ShapePrior prior{.arm = three_section_arm()};
  ArmState state = ArmState::straight(3);
  state.bends[1] = {0.9, 1.2};
  const std::vector<Observation> seen = observations_of(Backbone(prior.arm, state), random, 0.02);
  // Notes on uncertainty alone are switched off.
  const auto notes = [&] { return ShapeEstimator(prior, {.uncertain = 1}).estimate(seen).notes; };
  EXPECT_THAT(notes(), testing::IsEmpty());
  for (Section& section : prior.arm.sections) section.max_bend = 1.5;
  EXPECT_THAT(notes(), testing::IsEmpty());
  prior.arm.sections[1].max_bend = 1.2;
  EXPECT_THAT(notes(), testing::ElementsAre("section 2 would be bent by 86 degrees: its limit is 69"));
}

}  // namespace
}  // namespace flexura
