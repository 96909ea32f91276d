// Tests that all solutions are found, each once.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "flexura/kinematics/inverse.h"
#include "flexura/math/series.h"
#include "flexura/model/backbone.h"
#include "tests/support/arms.h"
#include "tests/support/inverse_targets.h"

namespace flexura {
namespace {

// Returns the largest distance of two arms at equal shares of their lengths, m.
double apart(const Arm& arm, const ArmState& a, const ArmState& b) {
  const Backbone first(arm, a);
  const Backbone second(arm, b);
  double largest = 0;
  for (int k = 0; k <= 50; ++k) {
    const Eigen::Vector3d p = first.pose(first.length() * k / 50).position;
    largest = std::max(largest, (p - second.pose(second.length() * k / 50).position).norm());
  }
  return largest;
}

void expect_distinct(const Arm& arm, const TipTarget& target, const std::vector<InverseResult>& solutions) {
  for (std::size_t i = 0; i < solutions.size(); ++i) {
    EXPECT_TRUE(solutions[i].converged());
    EXPECT_LE((Backbone(arm, solutions[i].state).tip().position - target.position).norm(),
              2e-9 * arm.length());
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(apart(arm, solutions[i].state, solutions[j].state), 0.5e-4 * arm.length()) << i << " " << j;
  }
}

Arm arm_of(ArmKind kind, const std::vector<double>& lengths, double max_bend) {
  Arm arm;
  arm.kind = kind;
  for (const double length : lengths)
    arm.sections.emplace_back(Section{.length = length, .max_bend = max_bend});
  return arm;
}

// Returns a pair for a planar arm of two sections: by how much the second one is too short to reach (x, y) of
// the base's plane, and the bend that points it there. x is along the base's x and y along its z.
std::pair<double, double> shortfall(const Arm& arm, double bend, double x, double y) {
  const double length = arm.sections[0].length;
  const double chord = length * sinc(bend / 2);
  const double dx = x - chord * std::sin(bend / 2);
  const double dy = y - chord * std::cos(bend / 2);
  const double half = std::remainder(std::atan2(dx, dy) - bend, 2 * std::numbers::pi);
  return {arm.sections[1].length * sinc(half) - std::hypot(dx, dy), 2 * half};
}

// Returns the first bends of all states that reach the point: the zeros of shortfall() between 20,000
// samples.
std::vector<double> brute_force(const Arm& arm, double x, double y) {
  constexpr int places = 20000;
  std::vector<double> found;
  const double most = arm.sections[0].max_bend;
  const auto at = [&](int k) { return -most + 2 * most * k / places; };
  for (int k = 0; k < places; ++k) {
    const auto [before, bend_before] = shortfall(arm, at(k), x, y);
    const auto [after, bend_after] = shortfall(arm, at(k + 1), x, y);
    const bool is_smooth = std::abs(bend_after - bend_before) < 1;  // No jump of a whole turn.
    if ((before < 0) == (after < 0) || !is_smooth) continue;
    if (std::abs(bend_before) <= arm.sections[1].max_bend) found.push_back(at(k));
  }
  return found;
}

TEST(Inverse, OfTwoPlanarSectionsListsWhatBruteForceFinds) {
  int most = 0;
  for_random_cases(60, [&](TestRandom& random) {
    const Arm arm = arm_of(ArmKind::planar, {random.uniform(0.3, 1), random.uniform(0.3, 1)}, 3.0);
    // In the world the base's x is X and its z is Y.
    ArmState state = ArmState::straight(2);
    for (Eigen::Vector2d& bend : state.bends) bend.x() = random.uniform(-2.9, 2.9);
    const TipTarget target{.position = Backbone(arm, state).tip().position};
    const auto bends = brute_force(arm, target.position.x(), target.position.y());
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      const auto solutions = all_inverse_solutions(arm, target, {.seed = seed});
      expect_distinct(arm, target, solutions);
      ASSERT_EQ(solutions.size(), bends.size()) << "seed of the starts " << seed;
      for (const double bend : bends) {
        EXPECT_TRUE(std::ranges::any_of(solutions, [&](const InverseResult& solution) {
          return std::abs(solution.state.bends[0].x() - bend) < 1e-3;
        })) << bend;
      }
    }
    most = std::max(most, static_cast<int>(bends.size()));
  });
  EXPECT_GE(most, 2) << "no case had two solutions";
}

// With limits below a whole turn. The direction of a section that is bent into a circle hardly changes the
// preference. So the end of such a valley is known to fewer digits (see the next test).
TEST(Inverse, ListsNoMinimumOfTheWishTwice) {
  int compared = 0, cases = 0;
  for_random_cases(20, [&](TestRandom& random) {
    const ArmKind kind = random.integer(0, 1) == 0 ? ArmKind::planar : ArmKind::spatial;
    const Arm arm = arm_of(kind, {0.3, 0.3, 0.3}, random.integer(0, 1) == 0 ? 2.5 : 5.5);
    ArmState state = ArmState::straight(3);
    for (Eigen::Vector2d& bend : state.bends) bend = random.vector<2>(-1.7, 1.7);
    if (kind == ArmKind::planar) {
      for (Eigen::Vector2d& bend : state.bends) bend.y() = 0;
    }
    const TipTarget target{.position = Backbone(arm, state).tip().position};
    const auto solutions = all_inverse_solutions(arm, target, {.max_starts = 150});
    expect_distinct(arm, target, solutions);
    ASSERT_FALSE(solutions.empty());
    ++cases;
    // Other starts must lead to the same minima (or to some not found before), not to others next to them.
    for (const InverseResult& other : all_inverse_solutions(arm, target, {.max_starts = 150, .seed = 7})) {
      for (const InverseResult& one : solutions) {
        const double distance = apart(arm, one.state, other.state);
        EXPECT_TRUE(distance < 2e-5 || distance > 1e-3) << distance;
        compared += distance < 2e-5 ? 1 : 0;
      }
    }
  });
  EXPECT_GE(compared, cases);
}

TEST(Inverse, ListsRollsOfAWholeTurnOnceAndNotInEveryDirection) {
  // Formerly 32 were listed.
  const Arm arm = arm_of(ArmKind::spatial, {0.3, 0.3, 0.3}, 6.5);
  const TipTarget target{.position = {-0.390251, 0.427663, -0.0089057}};
  for (const std::uint64_t seed : {1U, 7U}) {
    const auto solutions = all_inverse_solutions(arm, target, {.max_starts = 150, .seed = seed});
    expect_distinct(arm, target, solutions);
    EXPECT_LE(solutions.size(), 6U);
    EXPECT_GE(solutions.size(), 3U);
  }
}

TEST(Inverse, ListsEachMinimumOfThreePlanarSectionsOnce) {
  // Formerly two of eight differed by only 5e-5 rad.
  const Arm arm = arm_of(ArmKind::planar, {0.3, 0.3, 0.3}, std::numeric_limits<double>::infinity());
  const TipTarget target{.position = {0.2, 0.5, 0}};
  const auto solutions = all_inverse_solutions(arm, target);
  expect_distinct(arm, target, solutions);
  EXPECT_EQ(solutions.size(), 7U);
}

TEST(Inverse, ListsOneOfTheRingThatReachesATargetOnTheAxis) {
  const Arm arm = arm_of(ArmKind::spatial, {0.3, 0.3, 0.3}, 2.1);
  for (const bool has_direction : {false, true}) {
    TipTarget target{.position = {0, 0.78, 0}};
    if (has_direction) target.direction = Eigen::Vector3d(0, 2, 0);
    const auto solutions = all_inverse_solutions(arm, target);
    expect_distinct(arm, target, solutions);
    ASSERT_FALSE(solutions.empty());
    EXPECT_LE(solutions.size(), 4U);
    for (const InverseResult& solution : solutions) {
      EXPECT_GT(solution.state.bends[0].x(), 0.1);
      EXPECT_NEAR(solution.state.bends[0].y(), 0, 1e-9);
    }
    if (!has_direction) continue;
    // The bends a, -2 a, a in a plane come back to the axis, along it, at 0.9 sin(a) / a.
    EXPECT_TRUE(std::ranges::any_of(solutions, [](const InverseResult& solution) {
      const double a = solution.state.bends[0].x();
      return std::abs(0.9 * std::sin(a) / a - 0.78) < 1e-6 &&
             std::abs(solution.state.bends[1].x() + 2 * a) < 1e-6;
    }));
  }
}

}  // namespace
}  // namespace flexura
