// Arms that are tracked from a predicted centerline.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "flexura/vision/arm_finder.h"
#include "tests/support/plain_arms.h"

namespace flexura {
namespace {

using Eigen::Vector2d;

// The true centerline from base to tip, every tenth point, shifted by `shift` px and bent aside by `bend` px.
std::vector<Vector2d> prediction_of(const SeenArm& seen, const Vector2d& shift, double bend) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < seen.truth.size(); i += 10) {
    if (!seen.truth[i].pixel) continue;
    const double share = static_cast<double>(i) / static_cast<double>(seen.truth.size());
    points.push_back(*seen.truth[i].pixel + shift + bend * share * share * Vector2d(1, 0));
  }
  return points;
}

// The largest distance of an axis from the other, px.
double difference(const std::vector<AxisSample>& axis, const std::vector<AxisSample>& other) {
  double largest = 0;
  for (const AxisSample& sample : axis) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < other.size(); ++i) {
      const Vector2d along = other[i].pixel - other[i - 1].pixel, off = sample.pixel - other[i - 1].pixel;
      const double share = std::clamp(off.dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (off - share * along).norm());
    }
    largest = std::max(largest, nearest);
  }
  return largest;
}

TEST(ExpectedAxis, GivesTheSameCenterlineAsASearch) {
  ArmFinder finder;
  int whole = 0;
  for_random_cases(60, [&](TestRandom& random) {
    const SeenArm seen = random_seen_arm(random, {});
    const ArmObservation searched = finder.find(seen.picture);
    if (!searched.is_found()) return;
    finder.expect(prediction_of(seen, random.vector<2>(-6, 6), random.uniform(-8, 8)));
    const ArmObservation& found = finder.find(seen.picture);
    ASSERT_TRUE(found.is_found()) << found.reason;
    EXPECT_LT(rms_error(seen, found.axis), rms_error(seen, searched.axis) + 0.05);
    EXPECT_GE(found.covered, searched.covered - 0.02);
    if (!searched.is_whole()) return;
    // Both ends are the same; the base is the predicted one.
    ++whole;
    const bool is_turned = (found.ends[0].pixel - searched.ends[0].pixel).norm() >
                           (found.ends[0].pixel - searched.ends[1].pixel).norm();
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
      const AxisEnd& other = searched.ends[is_turned ? 1 - i : i];
      EXPECT_EQ(found.ends[i].kind, other.kind);
      EXPECT_LT((found.ends[i].pixel - other.pixel).norm(), 2);
    }
    EXPECT_LT(difference(found.axis, searched.axis), 2);
  });
  EXPECT_GT(whole * one_case_of, 30);
}

TEST(ExpectedAxis, PutsTheBaseWhereThePredictionHasIt) {
  const SeenArm seen = plain_arm(0.9);
  ArmFinder finder;
  std::vector<Vector2d> points = prediction_of(seen, {2, -1}, 0);
  finder.expect(points);
  const Vector2d base = finder.find(seen.picture).axis.front().pixel;
  EXPECT_LT((base - *seen.truth.front().pixel).norm(), 0.5);
  std::ranges::reverse(points);
  finder.expect(points);
  EXPECT_LT((finder.find(seen.picture).axis.front().pixel - *seen.truth.back().pixel).norm(), 0.5);
}

// A wrong prediction changes nothing, nor does one for an earlier picture.
TEST(ExpectedAxis, AWrongPredictionDoesNoHarm) {
  const SeenArm seen = plain_arm(0.7);
  ArmFinder finder;
  const std::vector<AxisSample> alone = finder.find(seen.picture).axis;
  const auto same = [&](std::vector<Vector2d> points) {
    finder.expect(points);
    const ArmObservation& found = finder.find(seen.picture);
    if (found.axis.size() != alone.size()) return false;
    for (std::size_t i = 0; i < alone.size(); ++i)
      if (found.axis[i].pixel != alone[i].pixel) return false;
    return true;
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(same({}));
  EXPECT_TRUE(same({{10, 10}}));
  EXPECT_TRUE(same({{nan, 10}, {20, nan}}));
  EXPECT_TRUE(same({{10, 10}, {10, 10}}));
  EXPECT_TRUE(same({{-1e300, 1e300}, {1e300, -1e300}}));
  EXPECT_TRUE(same(prediction_of(seen, {150, 0}, 0))) << "beside the arm";
  EXPECT_TRUE(same(prediction_of(seen, {0, 0}, 200))) << "of another shape";
  std::vector<Vector2d> twice = prediction_of(seen, {0, 0}, 0);
  const std::size_t half = twice.size() / 2;
  EXPECT_TRUE(same({twice.begin() + static_cast<std::ptrdiff_t>(half), twice.end()})) << "of half the arm";
  finder.expect(twice);
  (void)finder.find(seen.picture);
  EXPECT_TRUE(same({}));
}

// Where an arm crosses itself, its prediction leads past the crossing.
TEST(ExpectedAxis, LeadsThroughCrossings) {
  const SeenArm seen =
      bent_arm_in_view({{0, 2.6}, {0.1, 2.6}, {0, 1.2}}, 0.012, {0.1, 0.25, 1.7}, {0.1, 0.25, 0}, 800);
  ArmFinder finder;
  const ArmObservation searched = finder.find(seen.picture);
  ASSERT_TRUE(searched.is_found()) << searched.reason;
  finder.expect(prediction_of(seen, {3, 2}, 5));
  const ArmObservation& found = finder.find(seen.picture);
  ASSERT_TRUE(found.is_found()) << found.reason;
  EXPECT_GE(found.covered, searched.covered - 0.02);
  EXPECT_LT(rms_error(seen, found.axis), rms_error(seen, searched.axis) + 0.05);
}

}  // namespace
}  // namespace flexura
