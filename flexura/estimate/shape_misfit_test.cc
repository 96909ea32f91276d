// Tests whether the foreground of a picture is the image of a shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "flexura/estimate/shape_estimator.h"
#include "flexura/estimate/shape_silhouette.h"
#include "flexura/estimate/shape_start.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

constexpr double spacing = 4;  // px

// Points on the image of a tube of three_section_arm's radius.
std::vector<Eigen::Vector2d> figure_of(const Backbone& backbone, const View& view) {
  std::vector<Eigen::Vector2d> figure;
  constexpr int count = 120;
  for (int k = 0; k <= count; ++k) {
    const Pose X_WS = backbone.pose(std::min(backbone.length() * k / count, backbone.length()));
    const Eigen::Vector3d sight = (X_WS.position - view.X_WC.position).normalized(),
                          across = sight.cross(X_WS.rotation.col(2)).normalized();
    for (const double share : {-1.0, 0.0, 1.0})
      figure.push_back(view.project(X_WS.position + share * 0.02 * across).value());
  }
  return figure;
}

struct Seen {
  ShapePrior prior{.arm = three_section_arm()};
  Shape truth;
  std::vector<Observation> observations;
};
Seen random_seen(TestRandom& random) {
  Seen seen;
  seen.truth = {seen.prior.arm, random_bends(random, seen.prior.arm, 1.0), {}};
  const Backbone backbone(seen.truth.arm, seen.truth.state);
  seen.observations = observations_of(backbone, random, 0.02);
  for (Observation& one : seen.observations) one.figure = figure_of(backbone, one.view);
  return seen;
}

TEST(ShapeMisfit, IsNoneOfTheShapeAndSomeOfAnother) {
  for_random_cases(100, [](TestRandom& random) {
    const Seen seen = random_seen(random);
    EXPECT_LT(misfit(seen.observations, seen.truth), 1e-6);
    // Some 5 px or more at the tip: at least one camera sees a shift there and back.
    const Eigen::Vector2d bend = seen.truth.state.bends[2];
    for (Shape& other : bent_otherwise(seen.truth, 2, bend.norm() + 0.3, 4))
      if ((other.state.bends[2] - bend).norm() > 0.3) {
        EXPECT_GT(misfit(seen.observations, other), 0.002) << (other.state.bends[2] - bend).norm();
      }
  });
}

TEST(ShapeMisfit, CountsWhatTheShapeDoesNotExplainAndNotWhatIsHidden) {
  TestRandom random(1);
  const Seen seen = random_seen(random);
  Observation more = seen.observations[0], less = more, none = more;
  for (double u = 0; u < 40; u += spacing) more.figure.emplace_back(10 + u, 10);
  std::erase_if(less.figure,
                [&](const Eigen::Vector2d& place) { return (place - less.ends[1]->pixel).norm() < 60; });
  none.figure.clear();
  // The additional part is far off, and each point is bounded at 3 px.
  EXPECT_NEAR(misfit(more, {}, seen.truth), 9.0 * 10 / static_cast<double>(more.figure.size()), 0.2);
  // The tip may be hidden.
  EXPECT_LT(misfit(less, {}, seen.truth), 1e-6);
  EXPECT_EQ(misfit(none, {}, seen.truth), 0);
  // The picture's border cuts the arm: the part beyond is not missing.
  Observation cut = seen.observations[0];
  const double middle = 0.5 * (cut.ends[0]->pixel.x() + cut.ends[1]->pixel.x());
  ASSERT_GT(std::abs(cut.ends[1]->pixel.x() - middle), 60);
  cut.view.width = static_cast<int>(middle);
  std::erase_if(cut.figure, [&](const Eigen::Vector2d& place) { return place.x() > middle; });
  EXPECT_LT(misfit(cut, {}, seen.truth), 1e-6);
  Shape thin = seen.truth;
  for (Section& section : thin.arm.sections) section.radius = {0, 0};
  EXPECT_EQ(misfit(seen.observations[0], {}, thin), 0);
  more.figure.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_TRUE(std::isfinite(misfit(more, {}, seen.truth)));
}

TEST(ShapeMisfit, IsToldWhereThePictureShowsSomethingElse) {
  for_random_cases(20, [](TestRandom& random) {
    Seen seen = random_seen(random);
    ShapeEstimator estimator(seen.prior);
    const ShapeEstimate alone = estimator.estimate(seen.observations);
    ASSERT_TRUE(alone.is_trusted());
    for (double u = 0; u < 80; u += spacing) seen.observations[1].figure.emplace_back(10 + u, 10);
    const ShapeEstimate beside = estimator.estimate(seen.observations);
    ASSERT_TRUE(beside.is_found);
    EXPECT_FALSE(beside.is_trusted());
    const auto is_reported = [](const std::string& note) {
      return note.starts_with("parts of the foreground of picture 2 do not agree");
    };
    EXPECT_TRUE(std::ranges::any_of(beside.notes, is_reported));
    EXPECT_LT(shape_error(beside.shape, Backbone(seen.truth.arm, seen.truth.state)), 1e-3);
  });
}

// A picture that shows the first seven tenths. The end of the visible part may look like the tip; notes
// report the resulting errors.
TEST(ShapeMisfit, LeavesArmsThatAreHiddenInPart) {
  constexpr int cases = 200;
  int right = 0, wrong = 0;
  for_random_cases(cases, [&](TestRandom& random) {
    Seen seen = random_seen(random);
    const Backbone backbone(seen.truth.arm, seen.truth.state);
    const bool is_taken_for_tip = random.uniform(0, 1) < 0.5;
    Observation& part = seen.observations[static_cast<std::size_t>(random.uniform(0, 2))];
    part.points.resize(84), part.figure.resize(std::size_t{3} * 84);
    part.ends[1].reset();
    if (is_taken_for_tip) part.ends[1] = SeenEnd{part.points.back().pixel};
    const ShapeEstimate found = ShapeEstimator(seen.prior).estimate(seen.observations);
    const bool is_right = found.is_found && shape_error(found.shape, backbone) < 2e-3;
    right += is_right ? one_case_of : 0;
    if (found.is_found && !(shape_error(found.shape, backbone) < 1e-2)) wrong += one_case_of;
    EXPECT_TRUE(is_right || !found.is_trusted());
    EXPECT_FALSE(is_taken_for_tip && found.is_trusted());
  });
  EXPECT_GE(right, 0.8 * cases);
  // If two distant shapes explain the pictures, most arms are not found.
  EXPECT_LE(wrong, 0.075 * cases);
}

// A tube whose tip is a fifth as wide as its base is expected with the local width.
TEST(ShapeMisfit, GoesByTheWidthOfTaperedArms) {
  for_random_cases(20, [](TestRandom& random) {
    const Seen seen = random_seen(random);
    Shape tapered = seen.truth;
    const std::size_t count = tapered.arm.sections.size();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t end = 0; end < 2; ++end)
        tapered.arm.sections[i].radius.at(end) =
            0.02 * (1 - 0.8 * static_cast<double>(i + end) / static_cast<double>(count));
    // The silhouette has the full width: the part beside the tip is no longer explained, that at the base is.
    Observation base = seen.observations[0], tip = base;
    base.figure.resize(30), tip.figure.erase(tip.figure.begin(), tip.figure.end() - 30);
    EXPECT_LT(misfit(base, {}, tapered), 1e-6);
    EXPECT_GT(misfit(tip, {}, tapered), 0.1);
    EXPECT_LT(misfit(tip, {}, seen.truth), 1e-6);
  });
}

// Guide disks and rings are wider than the arm, and wide lenses stretch objects far from their middle.
TEST(ShapeMisfit, IsNotToldOfDisksOrOfWideLenses) {
  for_random_cases(20, [](TestRandom& random) {
    Seen seen = random_seen(random);
    for (Observation& one : seen.observations) {
      const std::vector<Eigen::Vector2d> places = one.figure;
      for (std::size_t k = 0; k + 2 < places.size(); k += 30)
        for (const std::size_t side : {k, k + 2})
          one.figure.emplace_back(places[side] + 0.8 * (places[side] - places[k + 1]));
    }
    EXPECT_GT(misfit(seen.observations, seen.truth), 0);
    const ShapeEstimate found = ShapeEstimator(seen.prior).estimate(seen.observations);
    EXPECT_TRUE(found.is_trusted()) << (found.notes.empty() ? found.reason : found.notes.front());
    // A camera near the arm, which is seen 40 degrees off its axis.
    const Backbone backbone(seen.truth.arm, seen.truth.state);
    View wide = view_from({0, 0.4, 0.9}, {0.75, 0.4, 0}, 300);
    Observation aside = seen.observations[0];
    aside.view = wide, aside.figure = figure_of(backbone, wide);
    EXPECT_LT(misfit(aside, {}, seen.truth), 0.005);
  });
}

}  // namespace
}  // namespace flexura
