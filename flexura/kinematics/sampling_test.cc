#include "flexura/kinematics/sampling.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/support/arms.h"

namespace flexura {
namespace {

double distance_to_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d along = b - a;
  const double fraction = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - fraction * along).norm();
}

// Largest distance of the arcs from the polyline through the samples.
double polyline_deviation(const Backbone& backbone, const std::vector<double>& s) {
  double largest = 0.0;
  for (std::size_t i = 0; i + 1 < s.size(); ++i) {
    const Eigen::Vector3d a = backbone.pose(s[i]).position;
    const Eigen::Vector3d b = backbone.pose(s[i + 1]).position;
    for (int k = 1; k < 16; ++k) {
      const Eigen::Vector3d p = backbone.pose(s[i] + (s[i + 1] - s[i]) * k / 16).position;
      largest = std::max(largest, distance_to_segment(p, a, b));
    }
  }
  return largest;
}

TEST(Sampling, StaysWithinTheTolerance) {
  for_random_cases(60, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const Backbone backbone(arm, random_state(random, arm));
    const double tolerance = std::pow(10.0, random.uniform(-7.0, 1.0));
    const std::vector<double> s = sample_arc_lengths(backbone, tolerance);
    EXPECT_LE(polyline_deviation(backbone, s), tolerance * (1.0 + 1e-6)) << tolerance;
  });
}

TEST(Sampling, TakesNoMorePointsThanItNeeds) {
  const Backbone backbone(paper_arm(), paper_state());
  const double tolerance = 1e-4;
  std::vector<double> s = sample_arc_lengths(backbone, tolerance);
  // One piece fewer in the most bent section breaks the tolerance.
  const Arc& last = backbone.arcs().back();
  const auto first = std::ranges::find(s, last.s);
  const auto pieces = s.end() - first - 1;
  ASSERT_GT(pieces, 2);
  s.erase(first, s.end());
  for (std::ptrdiff_t i = 0; i < pieces; ++i) {
    s.push_back(last.s + last.length * static_cast<double>(i) / static_cast<double>(pieces - 1));
  }
  EXPECT_GT(polyline_deviation(backbone, s), tolerance);
}

TEST(Sampling, RisesThroughEverySectionsEnds) {
  for_random_cases(60, [](TestRandom& random) {
    const Arm arm = random_arm(random);
    const Backbone backbone(arm, random_state(random, arm));
    const std::vector<double> s = sample_arc_lengths(backbone, 1e-3);
    EXPECT_TRUE(std::ranges::is_sorted(s, std::less_equal<>{}));
    EXPECT_EQ(s.front(), 0.0);
    EXPECT_EQ(s.back(), backbone.length());
    for (const Arc& arc : backbone.arcs()) EXPECT_TRUE(std::ranges::binary_search(s, arc.s));
  });
}

TEST(Sampling, AStraightArmNeedsOnlyItsSectionsEnds) {
  ArmState state = ArmState::straight(8);
  EXPECT_EQ(sample_arc_lengths(Backbone(paper_arm(), state), 1e-9).size(), 9u);
  for (Eigen::Vector2d& bend : state.bends) bend = {1e-12, 1e-160};
  EXPECT_EQ(sample_arc_lengths(Backbone(paper_arm(), state), 1e-9).size(), 9u);
}

TEST(Sampling, RefusesATolerancePastWhatDoublesCanTell) {
  const Backbone backbone(paper_arm(), paper_state());
  EXPECT_THROW((void)sample_arc_lengths(backbone, 0.0), std::invalid_argument);
  EXPECT_THROW((void)sample_arc_lengths(backbone, -1.0), std::invalid_argument);
  EXPECT_THROW((void)sample_arc_lengths(backbone, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
