// Tens of thousands of targets; docs/studies/ik.md has the long run.
#include <gtest/gtest.h>

#include "flexura/math/so3.h"
#include "tests/support/inverse_targets.h"

namespace flexura {
namespace {

void expect_solved_rate(TargetKind kind) {
  constexpr int count = 20000;
  int solved = 0;
  for_random_cases(count, [&](TestRandom& random) {
    const Arm arm = random_three_sections(random);
    const Pose X_WT = tip_pose(arm, random_state_within(random, arm));
    const InverseResult result = solve_inverse(arm, target_at(X_WT, kind));
    EXPECT_FALSE(result.is_proven);
    EXPECT_TRUE(is_within_limits(arm, result.state));
    if (!result.converged()) return;
    ++solved;
    const Pose X_WF = tip_pose(arm, result.state);
    EXPECT_LE((X_WF.position - X_WT.position).norm(), 2e-9 * arm.length());
    if (kind == TargetKind::direction) {
      EXPECT_LE((X_WF.rotation - X_WT.rotation).col(2).norm(), 2e-9);
    }
    if (kind == TargetKind::pose) {
      EXPECT_LE((X_WF.rotation - X_WT.rotation).norm(), 4e-9);
    }
  });
  EXPECT_GE(solved, 0.999 * count);
}

TEST(InverseAtLength, FindsReachablePositions) { expect_solved_rate(TargetKind::position); }
TEST(InverseAtLength, FindsReachableDirections) { expect_solved_rate(TargetKind::direction); }
TEST(InverseAtLength, FindsReachablePoses) { expect_solved_rate(TargetKind::pose); }

TEST(InverseAtLength, RefusesTargetsOutOfReach) {
  for_random_cases(5000, [](TestRandom& random) {
    Arm arm = random_three_sections(random);
    double at_least = 0.0;
    const TipTarget target = unreachable_target(random, random.integer(0, 3), arm, at_least);
    const InverseResult result = solve_inverse(arm, target);
    EXPECT_EQ(result.outcome, InverseOutcome::not_reachable);
    EXPECT_TRUE(result.is_proven);
    EXPECT_GE(result.position_error, at_least * (1 - 1e-12));
  });
}

}  // namespace
}  // namespace flexura
