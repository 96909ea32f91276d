// Arms without a kinematic model: a wrong base or camera; more than two pictures.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "flexura/base/degree.h"
#include "flexura/estimate/observation.h"
#include "flexura/estimate/shape_estimator.h"
#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

// An arm without a kinematic model adapts to any base: only its visible beginning shows the error.
TEST(ShapeOfUnknownMake, IsNotTrustedWhereTheBaseIsElsewhere) {
  for_random_cases(30, [](TestRandom& random) {
    const Arm arm = three_section_arm();
    const Backbone truth(arm, random_bends(random, arm, 1.2));
    const std::vector<Observation> seen = observations_of(truth, random, 0.02);
    const auto estimate = [&](const Eigen::Vector3d& base, const std::vector<Observation>& observations) {
      // Notes on uncertainty alone are switched off.
      return ShapeEstimator(unknown_arm(base, truth.length()), {.uncertain = 1}).estimate(observations);
    };
    const auto speaks_of_base = Contains(HasSubstr("px from the image of its base"));
    const ShapeEstimate right = estimate({0, 0, 0}, seen);
    EXPECT_TRUE(right.is_trusted()) << testing::PrintToString(right.notes);
    // Across its direction, 3 mm: a pixel.
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const ShapeEstimate beside = estimate({0.003 * std::cos(angle), 0, 0.003 * std::sin(angle)}, seen);
    EXPECT_FALSE(beside.is_trusted());
    EXPECT_THAT(beside.notes, speaks_of_base);
    // A camera rotated by a tenth of a degree: 1.4 px.
    std::vector<Observation> turned = seen;
    const int one = random.integer(0, 1);
    View& view = turned[static_cast<std::size_t>(one)].view;
    view.X_WC.rotation = view.X_WC.rotation * so3_exp({0, 0.1 * degree, 0});
    const ShapeEstimate aside = estimate({0, 0, 0}, turned);
    EXPECT_FALSE(aside.is_trusted());
    EXPECT_THAT(aside.notes, speaks_of_base);
    // With a prior of that size the error is estimated.
    for (Observation& uncertain : turned) uncertain.view_prior = {0.2 * degree, 0.001};
    EXPECT_THAT(estimate({0, 0, 0}, turned).notes, Not(speaks_of_base));
  });
}

// If the arm's beginning is not visible, there is no note about it.
TEST(ShapeOfUnknownMake, SaysNothingOfABaseThatNoPictureShows) {
  TestRandom random(1);
  const Arm arm = three_section_arm();
  const Backbone truth(arm, random_bends(random, arm, 1.0));
  std::vector<Observation> seen;
  for (const View& view : two_views()) seen.push_back(observation_of(truth, view, random, 0.02, {0.05, 1}));
  const ShapeEstimate found =
      ShapeEstimator(unknown_arm(Eigen::Vector3d(0.003, 0, 0), truth.length())).estimate(seen);
  EXPECT_TRUE(found.is_found) << found.reason;
  EXPECT_THAT(found.notes, Not(Contains(HasSubstr("px from the image of its base"))));
}

// The first two cameras stand beside each other and give no depth; the others' axes run either way.
TEST(ShapeOfUnknownMake, IsFoundInMoreThanTwoPictures) {
  for_random_cases(20, [](TestRandom& random) {
    const Arm arm = three_section_arm();
    const Backbone truth(arm, random_bends(random, arm, 1.2));
    const Eigen::Vector3d middle(0, 0.4, 0);
    const std::array<Eigen::Vector3d, 4> viewpoints = {
        Eigen::Vector3d(0, 0, 2.5), Eigen::Vector3d(0.02, 0, 2.5), Eigen::Vector3d(-2.5, 0, 0),
        Eigen::Vector3d(1.8, 0, 1.8)};
    std::vector<Observation> seen;
    for (const Eigen::Vector3d& eye : viewpoints) {
      Observation one = observation_of(truth, view_from(middle + eye, middle, 800), random, 0.02);
      const bool is_reversed = !seen.empty() && random.uniform(0, 1) < 0.5;
      seen.push_back(is_reversed ? reversed(one) : one);
    }
    const ShapeEstimate found = ShapeEstimator(unknown_arm(std::nullopt, std::nullopt)).estimate(seen);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LT(shape_error(found.shape, truth), 2e-3);
  });
}

// One of three pictures shows a fragment, in either direction: the start uses the others.
TEST(ShapeOfUnknownMake, IsFoundBesideAPictureOfAFragment) {
  for_random_cases(20, [](TestRandom& random) {
    const Arm arm = three_section_arm();
    const Backbone truth(arm, random_bends(random, arm, 1.2));
    const Eigen::Vector3d middle(0, 0.4, 0);
    const std::array<Eigen::Vector3d, 3> viewpoints = {
        Eigen::Vector3d(0, 0, 2.5), Eigen::Vector3d(-2.5, 0, 0), Eigen::Vector3d(1.8, 0, 1.8)};
    const auto fragment = static_cast<std::size_t>(random.integer(0, 2));
    const double from = random.uniform(0.2, 0.6);
    std::vector<Observation> seen;
    for (std::size_t i = 0; i < viewpoints.size(); ++i) {
      const View view = view_from(middle + viewpoints[i], middle, 800);
      const std::array<double, 2> shares =
          i == fragment ? std::array{from, from + 0.2} : std::array{0.0, 1.0};
      const Observation one = observation_of(truth, view, random, 0.02, shares);
      seen.push_back(i > 0 && random.uniform(0, 1) < 0.5 ? reversed(one) : one);
    }
    const ShapeEstimate found = ShapeEstimator(unknown_arm(std::nullopt, std::nullopt)).estimate(seen);
    ASSERT_TRUE(found.is_found) << found.reason;
    EXPECT_LT(shape_error(found.shape, truth), 2e-3) << "fragment in " << fragment;
  });
}

// On an arm that turns back, a fragment's far end may be nearer to the base.
TEST(ShapeOfUnknownMake, TellsWhichWayAFragmentOfAHairpinRuns) {
  for_random_cases(40, [](TestRandom& random) {
    Arm arm = three_section_arm();
    ArmState state = random_bends(random, arm, 0.6);
    const double angle = random.uniform(0, 2 * std::numbers::pi);
    const Eigen::Vector2d way(std::cos(angle), std::sin(angle));
    state.bends[1] = random.uniform(2.2, 2.8) * way, state.bends[2] = random.uniform(0.5, 1) * way;
    const Backbone truth(arm, state);
    const Eigen::Vector3d middle(0, 0.3, 0);
    const std::array<Eigen::Vector3d, 3> viewpoints = {
        Eigen::Vector3d(0, 0, 2.5), Eigen::Vector3d(-2.5, 0, 0), Eigen::Vector3d(1.8, 0, 1.8)};
    const double from = random.uniform(0.3, 0.65);
    std::vector<Observation> two, three;
    for (std::size_t i = 0; i < viewpoints.size(); ++i) {
      const View view = view_from(middle + viewpoints[i], middle, 800);
      const std::array<double, 2> shares = i == 2 ? std::array{from, from + 0.3} : std::array{0.0, 1.0};
      const Observation one = observation_of(truth, view, random, 0.02, shares);
      three.push_back(i == 2 && random.uniform(0, 1) < 0.5 ? reversed(one) : one);
      if (i < 2) two.push_back(one);
    }
    const Eigen::Vector3d base(0, 0, 0);
    for (const ShapePrior& prior :
         {described_arm(arm), unknown_arm(base, truth.length()), unknown_arm(base, std::nullopt),
          unknown_arm(std::nullopt, std::nullopt)}) {
      const ShapeEstimate without = ShapeEstimator(prior).estimate(two),
                          with = ShapeEstimator(prior).estimate(three);
      if (!without.is_found || shape_error(without.shape, truth) > 2e-3) continue;
      ASSERT_TRUE(with.is_found) << with.reason;
      EXPECT_LT(shape_error(with.shape, truth), 4e-3);
    }
  });
}

}  // namespace
}  // namespace flexura
