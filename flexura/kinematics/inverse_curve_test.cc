// Tests inverse kinematics of the whole arm: along a curve, or as near as possible.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/kinematics/inverse.h"
#include "flexura/kinematics/spatial.h"
#include "flexura/model/backbone.h"
#include "tests/support/arms.h"
#include "tests/support/inverse_targets.h"

namespace flexura {
namespace {

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

// Its ends are in reach; between them the curve bends by more than the arm can.
TEST(Inverse, SaysThatALimitKeepsItFromACurve) {
  Arm able;
  able.kind = ArmKind::spatial;
  able.sections.resize(3, {.length = 0.3, .max_bend = 2.5});
  const Backbone bent(able, {{{1.8, 0}, {-1.8, 0.2}, {0.9, 0}}, {1, 1, 1}});
  CurveTarget target;
  for (int k = 0; k <= 300; ++k) target.points.push_back(bent.pose(bent.length() * k / 300).position);
  EXPECT_TRUE(solve_inverse(able, target, {}).converged());
  Arm stiff = able;
  for (Section& section : stiff.sections) section.max_bend = 1.2;
  const InverseResult result = solve_inverse(stiff, target, {});
  EXPECT_EQ(result.outcome, InverseOutcome::at_limit) << name_of(result.outcome);
  EXPECT_FALSE(result.is_proven);
  EXPECT_GT(result.position_error, result.position_tolerance);
  EXPECT_TRUE(is_within_limits(stiff, result.state));
}

// Returns the point of a polyline at a share of its length.
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

// Returns the largest distance of the arm from the polyline at equal shares of both lengths.
double distance_from_curve(const Arm& arm, const ArmState& state, const CurveTarget& target) {
  const Backbone backbone(arm, state);
  double largest = 0.0;
  for (int k = 0; k <= 1000; ++k) {
    const Eigen::Vector3d p = backbone.pose(backbone.length() * k / 1000).position;
    largest = std::max(largest, (p - point_at(target.points, k / 1000.0)).norm());
  }
  return largest;
}

// Returns the polyline of a random state of the arm, with `pieces` of equal length per section.
CurveTarget random_polyline(TestRandom& random, const Arm& arm, int pieces) {
  const Backbone backbone(arm, random_state_within(random, arm));
  CurveTarget target;
  const int all = pieces * static_cast<int>(arm.sections.size());
  for (int k = 0; k <= all; ++k) target.points.push_back(backbone.pose(backbone.length() * k / all).position);
  return target;
}

// Returns true if a piece took all of a short section's bend, so that an arc became a corner.
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
    // The uncertainty of its points is within the tolerance.
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
    // The caller's tolerance applies.
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
  // Curves of other arms: a minimum must be found and reported as one, with few exceptions.
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

}  // namespace
}  // namespace flexura
