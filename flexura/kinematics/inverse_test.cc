#include "flexura/kinematics/inverse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "flexura/math/so3.h"
#include "flexura/model/backbone.h"
#include "tests/support/arms.h"
#include "tests/support/inverse_targets.h"

namespace flexura {
namespace {

// The model's forward kinematics of an answer, against the question.
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
    // Neither local descents, from there and from elsewhere, nor chance find anything nearer.
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
    const InverseResult wished = solve_inverse(arm, target, {.wish = InverseWish::least_bending});
    expect_solves(arm, target, wished);
    EXPECT_LE(bending(wished.state), bending(plain.state) + 1e-9);
    // No solution close by bends less.
    for (int i = 0; i < 10; ++i) {
      ArmState start = wished.state;
      for (Eigen::Vector2d& bend : start.bends) bend += random.vector<2>(-0.02, 0.02);
      const InverseResult other = solve_inverse(arm, target, {.start = start});
      if (!other.converged()) continue;
      EXPECT_GE(bending(other.state), bending(wished.state) - 1e-5);
    }
  });
}

// The squares of bends and stretches relative to their ranges, as mid_range weighs them.
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
  const InverseResult mid = solve_inverse(arm, target, {.wish = InverseWish::mid_range});
  const InverseResult least = solve_inverse(arm, target, {.wish = InverseWish::least_bending});
  expect_solves(arm, target, mid);
  expect_solves(arm, target, least);
  EXPECT_LT(distance_from_middle(arm, mid.state), distance_from_middle(arm, least.state) - 1e-3);
}

TEST(Inverse, SaysThatALimitHoldsIt) {
  // Within the hull of what the arm reaches, but in the hollow that its limits leave; not proven, yet held.
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

TEST(Inverse, LaysTheArmAlongACurve) {
  for_random_cases(60, [](TestRandom& random) {
    Arm arm = random_arm(random);
    arm.kind = random.integer(0, 1) == 0 ? ArmKind::planar : ArmKind::spatial;
    const bool stretches = random.integer(0, 1) == 0;
    for (Section& section : arm.sections) {
      section.max_bend = 2.5;
      if (stretches) section.stretch_limits = {0.9, 1.2};
    }
    const ArmState state = random_state_within(random, arm);
    const Backbone backbone(arm, state);
    CurveTarget target;
    for (int k = 0; k <= 1000; ++k) {
      target.points.push_back(backbone.pose(backbone.length() * k / 1000).position);
    }
    const InverseResult result = solve_inverse(arm, target, {.position_tolerance = 1e-4 * arm.length()});
    EXPECT_TRUE(result.converged()) << result.position_error / arm.length();
    EXPECT_TRUE(is_within_limits(arm, result.state));
  });
}

TEST(Inverse, APolylineIsAsFarFromItsCurveAsThisSays) {
  // A quarter of a circle of radius 1 in n pieces, against the circle itself.
  for (const int n : {2, 3, 10, 100}) {
    std::vector<Eigen::Vector3d> points;
    const double turn = 0.5 * std::numbers::pi / n;
    for (int k = 0; k <= n; ++k) points.emplace_back(std::cos(k * turn), std::sin(k * turn), 0.0);
    const double bulge = 1 - std::cos(turn / 2);
    const double missing = n * (turn - 2 * std::sin(turn / 2));
    EXPECT_NEAR(polyline_error(points), bulge + missing, 1e-12) << n;
  }
  EXPECT_EQ(polyline_error({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {3, 0, 0}}), 0.0) << "straight";
  EXPECT_EQ(polyline_error({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}), 0.0) << "a corner";
}

// The point of a polyline at a part of its length.
Eigen::Vector3d point_at(const std::vector<Eigen::Vector3d>& points, double part) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  double left = part * length;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double piece = (points[i] - points[i - 1]).norm();
    if (left <= piece) return points[i - 1] + (left / piece) * (points[i] - points[i - 1]);
    left -= piece;
  }
  return points.back();
}

// How far the arm is from the polyline, by the parts of either's length.
double distance_from_curve(const Arm& arm, const ArmState& state, const CurveTarget& target) {
  const Backbone backbone(arm, state);
  double largest = 0.0;
  for (int k = 0; k <= 1000; ++k) {
    const Eigen::Vector3d p = backbone.pose(backbone.length() * k / 1000).position;
    largest = std::max(largest, (p - point_at(target.points, k / 1000.0)).norm());
  }
  return largest;
}

// Of a random state of the arm, `pieces` of the same length for each section.
CurveTarget random_polyline(TestRandom& random, const Arm& arm, int pieces) {
  const Backbone backbone(arm, random_state_within(random, arm));
  CurveTarget target;
  const int all = pieces * static_cast<int>(arm.sections.size());
  for (int k = 0; k <= all; ++k) target.points.push_back(backbone.pose(backbone.length() * k / all).position);
  return target;
}

// Whether a piece took all of a short section's bend, so that what was an arc is a corner that means what it
// says.
bool has_corner(const std::vector<Eigen::Vector3d>& points) {
  for (std::size_t i = 2; i < points.size(); ++i) {
    const Eigen::Vector3d before = (points[i - 1] - points[i - 2]).normalized();
    if (before.dot((points[i] - points[i - 1]).normalized()) <= 0.5) return true;
  }
  return false;
}

TEST(Inverse, LaysTheArmAlongACurveThatIsGivenByAFewPoints) {
  int fitting = 0;
  int coarse = 0;
  int too_coarse = 0;
  for_random_cases(300, [&](TestRandom& random) {
    Arm arm = random_arm(random);
    arm.kind = random.integer(0, 1) == 0 ? ArmKind::planar : ArmKind::spatial;
    for (Section& section : arm.sections) section.max_bend = 1.5;
    const CurveTarget target = random_polyline(random, arm, random.integer(3, 9));
    const double open = (1e-3 + 2 * polyline_error(target.points) / arm.length());
    const InverseResult result = solve_inverse(arm, target);
    const double error = result.position_error;
    const double cap = 1e-2 * arm.length();
    EXPECT_NEAR(result.position_tolerance, std::min(open * arm.length(), cap), 1e-12 * arm.length());
    // What its points leave open is within what is allowed.
    if (open <= 1e-2 && !has_corner(target.points)) {
      EXPECT_TRUE(result.converged()) << error / arm.length() << " of " << open;
      ++fitting;
    } else {
      EXPECT_EQ(result.converged(), error <= result.position_tolerance);
    }
    const double sampled = distance_from_curve(arm, result.state, target);
    EXPECT_LE(sampled, 1.01 * error + 1e-9);
    EXPECT_GE(sampled, 0.9 * error - 1e-9);
    coarse += result.converged() && error > 1e-3 * arm.length() ? 1 : 0;
    too_coarse += result.converged() ? 0 : 1;
    // What the caller allows is what counts.
    if (error < 1e-6) return;
    EXPECT_TRUE(solve_inverse(arm, target, {.position_tolerance = 1.01 * error}).converged());
    EXPECT_FALSE(solve_inverse(arm, target, {.position_tolerance = 0.3 * error}).converged());
  });
  EXPECT_GE(fitting, 50 / one_case_of);
  EXPECT_GE(coarse, 20 / one_case_of) << "no polyline was coarse enough to matter";
  EXPECT_GE(too_coarse, 1) << "none was too coarse";
}

TEST(Inverse, NeverFollowsACoarseCurveThatItMisses) {
  int missed = 0;
  for_random_cases(200, [&](TestRandom& random) {
    Arm arm = random_arm(random);
    for (Section& section : arm.sections) section.max_bend = 2.8;
    const CurveTarget target = random_polyline(random, arm, 3);
    for (Section& section : arm.sections) section.max_bend = 0.5;
    const InverseResult result = solve_inverse(arm, target);
    const double apart = distance_from_curve(arm, result.state, target) / arm.length();
    if (apart <= 1.1e-2) return;
    EXPECT_FALSE(result.converged()) << apart;
    missed += apart > 0.05 ? 1 : 0;
  });
  EXPECT_GE(missed, 100 / one_case_of) << "by so much that anyone sees it";
}

TEST(Inverse, DecidesOnCurvesThatTheArmCannotFollow) {
  // Curves of other arms: a minimum is found, and said to be one, but for the odd case.
  int asked = 0;
  int undecided = 0;
  for_random_cases(150, [&](TestRandom& random) {
    Arm arm = random_arm(random);
    for (Section& section : arm.sections) section.max_bend = random.uniform(0.5, 4);
    Arm other = arm;
    for (Section& section : other.sections) {
      section.length *= random.uniform(0.7, 1.2);
      section.max_bend = 3;
    }
    const Backbone backbone(other, random_state_within(random, other));
    CurveTarget target;
    for (int k = 0; k <= 20; ++k) target.points.push_back(backbone.pose(backbone.length() * k / 20).position);
    const InverseResult result = solve_inverse(arm, target);
    ++asked;
    undecided += result.outcome == InverseOutcome::no_convergence ? 1 : 0;
    EXPECT_TRUE(is_within_limits(arm, result.state));
    EXPECT_GE(result.position_error, 0.0);
    EXPECT_EQ(result.tip, tip_pose(arm, result.state).position);
  });
  EXPECT_LE(undecided, 1 + 0.02 * asked);
}

TEST(Inverse, SaysHowFarAnImpossibleCurveIs) {
  const Arm arm = paper_arm();
  const InverseResult longer = solve_inverse(arm, CurveTarget{{{0, 0, 0}, {0, 20, 0}}});
  EXPECT_EQ(longer.outcome, InverseOutcome::not_reachable);
  EXPECT_TRUE(longer.is_proven);
  EXPECT_NEAR(longer.position_error, 4.0, 1e-6);
  const InverseResult elsewhere = solve_inverse(arm, CurveTarget{{{1, 0, 0}, {1, 16, 0}}});
  EXPECT_EQ(elsewhere.outcome, InverseOutcome::not_reachable);
  EXPECT_GE(elsewhere.position_error, 1.0);
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
