#include "flexura/kinematics/inverse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "flexura/math/so3.h"
#include "tests/support/arms.h"
#include "tests/support/inverse_targets.h"

namespace flexura {
namespace {

// Checks a result against its target with the model's forward kinematics.
void expect_solves(const Arm& arm, const TipTarget& target, const InverseResult& result) {
  ASSERT_TRUE(result.converged()) << static_cast<int>(result.outcome);
  EXPECT_FALSE(result.is_proven);
  EXPECT_TRUE(is_within_limits(arm, result.state));
  const Pose X_WT = tip_pose(arm, result.state);
  EXPECT_LE((X_WT.position - target.position).norm(), 2e-9 * arm.length());
  if (target.direction) {
    EXPECT_LE((X_WT.rotation.col(2) - target.direction->normalized()).norm(), 2e-9);
  }
  if (target.rotation) {
    EXPECT_LE(so3_log(target.rotation->transpose() * X_WT.rotation).norm(), 2e-9);
  }
  EXPECT_EQ(result.tip, X_WT.position);
}

void expect_solved_rate(TargetKind kind, int count, double least) {
  int asked = 0;
  int solved = 0;
  for_random_cases(count, [&](TestRandom& random) {
    ++asked;
    const Arm arm = random_three_sections(random);
    const TipTarget target = target_at(tip_pose(arm, random_state_within(random, arm)), kind);
    const InverseResult result = solve_inverse(arm, target);
    EXPECT_FALSE(result.is_proven);
    EXPECT_TRUE(is_within_limits(arm, result.state));
    if (!result.converged()) return;
    ++solved;
    expect_solves(arm, target, result);
  });
  EXPECT_GE(solved, least * asked);
}

TEST(Inverse, FindsRandomReachablePositions) { expect_solved_rate(TargetKind::position, 2000, 0.999); }
TEST(Inverse, FindsRandomReachableDirections) { expect_solved_rate(TargetKind::direction, 2000, 0.999); }
TEST(Inverse, FindsRandomReachablePoses) { expect_solved_rate(TargetKind::pose, 2000, 0.999); }

TEST(Inverse, FindsTargetsOfArmsOfEveryKind) {
  for_random_cases(300, [](TestRandom& random) {
    Arm arm = random_arm(random);
    arm.kind = random.integer(0, 1) == 0 ? ArmKind::planar : ArmKind::spatial;
    for (Section& section : arm.sections) {
      section.max_bend = random.uniform(0.5, 3.0);
      if (random.integer(0, 1) == 0) section.stretch_limits = {0.8, 1.3};
    }
    const auto kind = static_cast<TargetKind>(random.integer(0, 2));
    const TipTarget target = target_at(tip_pose(arm, random_state_within(random, arm)), kind);
    const InverseResult result = solve_inverse(arm, target);
    EXPECT_FALSE(result.is_proven);
    expect_solves(arm, target, result);
  });
}

TEST(Inverse, RefusesTargetsProvablyOutOfReachWithTheNearestPose) {
  for_random_cases(1000, [](TestRandom& random) {
    Arm arm = random_three_sections(random);
    double at_least = 0.0;
    const int way = random.integer(0, 3);
    const TipTarget target = unreachable_target(random, way, arm, at_least);
    const InverseResult result = solve_inverse(arm, target);
    SCOPED_TRACE(way);
    EXPECT_EQ(result.outcome, InverseOutcome::not_reachable);
    EXPECT_TRUE(result.is_proven);
    EXPECT_TRUE(is_within_limits(arm, result.state));
    EXPECT_GE(result.position_error, at_least * (1 - 1e-12));
    EXPECT_EQ(result.tip, tip_pose(arm, result.state).position);
    // Neither local descents, from there and from elsewhere, nor random states must find anything nearer.
    const auto miss = [&](const ArmState& state) { return miss_of(arm, target, state); };
    for (int i = 0; i < 3; ++i) {
      const ArmState start = i == 0 ? result.state : random_state_within(random, arm);
      EXPECT_GE(random_descent(random, arm, start, 300, miss), miss(result.state) * (1 - nearer_by(target)))
          << i;
    }
    if (way == 3) return;
    for (int i = 0; i < 100; ++i) {
      ArmState other = i < 50 ? random_state_within(random, arm) : result.state;
      for (std::size_t k = 0; k < 3 && i >= 50; ++k) {
        other.bends[k] += random.vector<2>(-1e-2, 1e-2);
        other.bends[k] *= std::min(1.0, arm.sections[k].max_bend / other.bends[k].norm());
      }
      EXPECT_GE((tip_pose(arm, other).position - target.position).norm(), result.position_error * (1 - 1e-9));
    }
  });
}

TEST(Inverse, OfAPlanarArmKeepsToItsPlane) {
  const Arm arm = paper_arm();
  const Eigen::Vector3d E = tip_pose(arm, paper_state()).position;
  expect_solves(arm, {.position = E}, solve_inverse(arm, {.position = E}));
  const InverseResult off = solve_inverse(arm, {.position = E + Eigen::Vector3d(0, 0, 0.5)});
  EXPECT_EQ(off.outcome, InverseOutcome::not_reachable);
  EXPECT_TRUE(off.is_proven);
  EXPECT_NEAR(off.position_error, 0.5, 1e-9);
  EXPECT_NEAR((off.tip - E).norm(), 0.0, 1e-6);
  const InverseResult turned = solve_inverse(arm, {.position = E, .direction = Eigen::Vector3d(1, 0, 1)});
  EXPECT_EQ(turned.outcome, InverseOutcome::not_reachable);
  EXPECT_TRUE(turned.is_proven);
}

TEST(Inverse, TheSameQuestionHasTheSameAnswer) {
  for_random_cases(20, [](TestRandom& random) {
    const Arm arm = random_three_sections(random);
    const TipTarget target = target_at(tip_pose(arm, random_state_within(random, arm)), TargetKind::pose);
    const InverseResult one = solve_inverse(arm, target);
    const InverseResult two = solve_inverse(arm, target);
    EXPECT_EQ(one.state.bends, two.state.bends);
    EXPECT_EQ(one.iterations, two.iterations);
  });
}

TEST(Inverse, BeginsAtTheStartGiven) {
  for_random_cases(50, [](TestRandom& random) {
    const Arm arm = random_three_sections(random);
    const ArmState state = random_state_within(random, arm);
    const InverseResult there =
        solve_inverse(arm, target_at(tip_pose(arm, state), TargetKind::position), {.start = state});
    EXPECT_TRUE(there.converged());
    EXPECT_LE(there.iterations, 2);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LE((there.state.bends[i] - state.bends[i]).norm(), 1e-6);
  });
}

double bending(const ArmState& state) {
  double sum = 0.0;
  for (const Eigen::Vector2d& bend : state.bends) sum += bend.squaredNorm();
  return sum;
}

TEST(Inverse, LeastBendingBendsLeastNearby) {
  for_random_cases(100, [](TestRandom& random) {
    const Arm arm = random_three_sections(random);
    const TipTarget target = target_at(tip_pose(arm, random_state_within(random, arm)), TargetKind::position);
    const InverseResult plain = solve_inverse(arm, target);
    const InverseResult with_objective =
        solve_inverse(arm, target, {.objective = InverseObjective::least_bending});
    expect_solves(arm, target, with_objective);
    EXPECT_LE(bending(with_objective.state), bending(plain.state) + 1e-9);
    // No solution close by may bend less.
    for (int i = 0; i < 10; ++i) {
      ArmState start = with_objective.state;
      for (Eigen::Vector2d& bend : start.bends) bend += random.vector<2>(-0.02, 0.02);
      const InverseResult other = solve_inverse(arm, target, {.start = start});
      if (!other.converged()) continue;
      EXPECT_GE(bending(other.state), bending(with_objective.state) - 1e-5);
    }
  });
}

// Returns the squares of bends and stretches relative to their ranges, as weighted by mid_range.
double distance_from_middle(const Arm& arm, const ArmState& state) {
  double sum = 0.0;
  for (std::size_t i = 0; i < arm.sections.size(); ++i) {
    const auto [low, high] = arm.sections[i].stretch_limits;
    const double stretch = (state.stretches[i] - 0.5 * (low + high)) / (0.5 * (high - low));
    sum += state.bends[i].squaredNorm() / (arm.sections[i].max_bend * arm.sections[i].max_bend);
    sum += stretch * stretch;
  }
  return sum;
}

TEST(Inverse, MidRangeTradesBendingForStretchesAwayFromTheirLimits) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (const double max_bend : {2.5, 0.9}) {
    arm.sections.emplace_back(Section{.length = 0.3, .max_bend = max_bend, .stretch_limits = {0.8, 1.1}});
  }
  const TipTarget target{.position = {0.2, 0.5, 0.1}};
  const InverseResult mid = solve_inverse(arm, target, {.objective = InverseObjective::mid_range});
  const InverseResult least = solve_inverse(arm, target, {.objective = InverseObjective::least_bending});
  expect_solves(arm, target, mid);
  expect_solves(arm, target, least);
  EXPECT_LT(distance_from_middle(arm, mid.state), distance_from_middle(arm, least.state) - 1e-3);
}

TEST(Inverse, SaysThatALimitHoldsIt) {
  // Within the hull of the reachable set, but in the hollow due to the limits: not proven, yet held by a
  // limit.
  Arm arm;
  arm.kind = ArmKind::planar;
  for (int i = 0; i < 3; ++i) {
    arm.sections.emplace_back().length = 0.3;
    arm.sections.back().max_bend = 1.0;
    arm.sections.back().stretch_limits = {0.99, 1.01};
  }
  const InverseResult result = solve_inverse(arm, {.position = {0.0, 0.6, 0.0}});
  EXPECT_FALSE(result.converged());
  EXPECT_EQ(result.outcome, InverseOutcome::at_limit);
  EXPECT_FALSE(result.is_proven);
  EXPECT_TRUE(is_within_limits(arm, result.state));
}

TEST(Inverse, SaysThatOneSectionHasTooFewFreedoms) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.emplace_back().length = 1.0;
  const InverseResult result = solve_inverse(arm, {.position = {0.1, 0.5, 0.2}});
  EXPECT_EQ(result.outcome, InverseOutcome::not_reachable);
  EXPECT_FALSE(result.is_proven);
  EXPECT_GT(result.position_error, 1e-3);
}

TEST(Inverse, AllSolutionsOfAPoseAreDistinctAndSolveIt) {
  for_random_cases(5, [](TestRandom& random) {
    const Arm arm = random_three_sections(random);
    const ArmState state = random_state_within(random, arm);
    const TipTarget target = target_at(tip_pose(arm, state), TargetKind::pose);
    const auto solutions = all_inverse_solutions(arm, target, {.start = state, .max_starts = 60});
    ASSERT_FALSE(solutions.empty());
    bool is_own_found = false;
    for (std::size_t i = 0; i < solutions.size(); ++i) {
      expect_solves(arm, target, solutions[i]);
      double own = 0.0;
      for (std::size_t k = 0; k < 3; ++k) own += (solutions[i].state.bends[k] - state.bends[k]).norm();
      is_own_found = is_own_found || own < 1e-3;
      for (std::size_t j = 0; j < i; ++j) {
        double apart = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
          apart += (solutions[i].state.bends[k] - solutions[j].state.bends[k]).norm();
        EXPECT_GT(apart, 1e-5);
      }
    }
    EXPECT_TRUE(is_own_found);
  });
}

TEST(Inverse, OfAPlanarArmOfTwoSectionsHasTheElbowOnEitherSide) {
  Arm arm;
  for (int i = 0; i < 2; ++i) arm.sections.emplace_back(Section{.length = 0.5, .max_bend = 2.5});
  const auto solutions = all_inverse_solutions(arm, {.position = {0.0, 0.8, 0.0}}, {.max_starts = 50});
  ASSERT_EQ(solutions.size(), 2U);
  EXPECT_NEAR(solutions[0].state.bends[0].x(), -solutions[1].state.bends[0].x(), 1e-6);
}

TEST(Inverse, RefusesWhatCannotBeAsked) {
  const Arm arm = paper_arm();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d p(1, 2, 0);
  const Eigen::Vector3d z(0, 0, 1);
  const Eigen::Matrix3d mirror = -Eigen::Matrix3d::Identity();
  EXPECT_THROW((void)solve_inverse(arm, {.position = {nan, 0, 0}}), std::invalid_argument);
  EXPECT_THROW((void)solve_inverse(arm, {.position = p, .direction = Eigen::Vector3d::Zero()}),
               std::invalid_argument);
  EXPECT_THROW((void)solve_inverse(arm, {.position = p, .rotation = mirror}), std::invalid_argument);
  EXPECT_THROW(
      (void)solve_inverse(arm, {.position = p, .direction = z, .rotation = Eigen::Matrix3d::Identity()}),
      std::invalid_argument);
  EXPECT_THROW((void)solve_inverse(arm, {.position = p}, {.start = ArmState::straight(3)}),
               std::invalid_argument);
  EXPECT_THROW((void)solve_inverse(arm, {.position = p}, {.position_tolerance = 0.0}), std::invalid_argument);
  EXPECT_THROW((void)solve_inverse(arm, CurveTarget{{p, p}}), std::invalid_argument);
  EXPECT_THROW((void)solve_inverse(Arm{}, {.position = p}), std::invalid_argument);
}

}  // namespace
}  // namespace flexura
