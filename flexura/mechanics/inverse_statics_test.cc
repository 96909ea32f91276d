#include "flexura/mechanics/inverse_statics.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <vector>

#include "flexura/math/dense.h"
#include "flexura/math/so3.h"
#include "tests/support/known_rods.h"
#include "tests/support/random_cases.h"
#include "tests/support/random_rods.h"

namespace flexura {
namespace {

constexpr double most_pull = 8;

Rod coarse(Rod rod) {
  for (RodSection& section : rod.sections) section.modes = {.shear = 1, .stretch = 1, .bend = 3, .twist = 2};
  return rod;
}

double effort_of(const std::vector<double>& tensions) {
  double sum = 0;
  for (const double tension : tensions) sum += tension * tension;
  return sum;
}

std::vector<double> all_of(const Rod& rod, double most) { return std::vector(rod.tendons.size(), most); }

void expect_reached(const InverseStaticsResult& result, const std::vector<double>& most) {
  ASSERT_TRUE(result.reached()) << words(result.end) << ": " << result.problem;
  EXPECT_LE(result.position_error, 1e-8);
  EXPECT_TRUE(result.equilibrium.converged());
  ASSERT_EQ(result.tensions.size(), most.size());
  for (std::size_t i = 0; i < most.size(); ++i)
    EXPECT_TRUE(result.tensions[i] >= 0 && result.tensions[i] <= most[i]) << result.tensions[i];
  EXPECT_NEAR(result.effort, effort_of(result.tensions), 1e-12 * result.effort);
}

// A target that is known to be within reach.
struct Made {
  Made(TestRandom& random, bool is_loaded)
      : rod(coarse(random_rod(random))),
        tensions(random_tensions(random, rod, 6)),
        loads(is_loaded ? random_loads(random, rod) : RodLoads{}),
        statics(rod),
        at(statics.solve({.tensions = tensions}, loads)),
        most(all_of(rod, most_pull)) {}

  Rod rod;
  std::vector<double> tensions;
  RodLoads loads;
  RodStatics statics;
  Equilibrium at;
  std::vector<double> most;
};

void expect_no_more_effort(int cases, bool is_loaded) {
  int evaluations = 0, count = 0;
  for_random_cases(cases, [&](TestRandom& random) {
    Made made(random, is_loaded);
    ASSERT_TRUE(made.at.converged());
    if (!made.at.stable) return;
    const RodTarget target{.position = made.at.tip.position};
    const double enough = (1 + 1e-6) * effort_of(made.tensions) + 1e-12;
    const InverseStaticsResult first = solve_inverse_statics(made.statics, target, made.loads, made.most);
    expect_reached(first, made.most);
    evaluations += first.evaluations, ++count;
    // What is found is where the tip comes to rest, too.
    const Equilibrium again = RodStatics(made.rod).solve({.tensions = first.tensions}, made.loads);
    ASSERT_TRUE(again.converged());
    EXPECT_LE((again.tip.position - made.at.tip.position).norm(), 1e-7);
    EXPECT_EQ(first.equilibrium.displacements.size(), made.most.size());
    // The minimum next to the tensions that made it.
    const InverseStaticsResult beside =
        solve_inverse_statics(made.statics, target, made.loads, made.most, {.start = made.at});
    expect_reached(beside, made.most);
    EXPECT_LE(beside.effort, enough);
    if (first.effort <= enough) return;
    // The nearest minimum was another.
    const InverseStaticsResult best = solve_inverse_statics(made.statics, target, made.loads, made.most,
                                                            {.max_starts = 60, .all_starts = true});
    expect_reached(best, made.most);
    EXPECT_LE(best.effort, enough);
  });
  std::printf("%.1f equilibria a target\n", static_cast<double>(evaluations) / std::max(1, count));
}

TEST(InverseStatics, TargetsThatTensionsMadeAreReachedWithNoMoreEffort) { expect_no_more_effort(60, false); }

TEST(InverseStatics, UnderLoadsToo) { expect_no_more_effort(40, true); }

TEST(InverseStatics, AtTheLeastEffortNoTensionsThatKeepTheTipAreLess) {
  int redundant = 0, missed = 0, count = 0;
  for_random_cases(60, [&](TestRandom& random) {
    Made made(random, random.integer(0, 1) == 0);
    ASSERT_TRUE(made.at.converged());
    if (!made.at.stable) return;
    const InverseStaticsResult result =
        solve_inverse_statics(made.statics, {.position = made.at.tip.position}, made.loads, made.most);
    expect_reached(result, made.most);
    ++count;
    // Where J is nearly singular, nanometres cost newtons, and the tolerance hides the minimum.
    if (!result.is_least) ++missed;
    // Karush's, Kuhn's and Tucker's conditions, where they are unique.
    const Eigen::MatrixXd J = made.statics.slopes().tip_by_input.topRows<3>();
    const auto tensions = Eigen::Map<const Eigen::VectorXd>(result.tensions.data(), J.cols());
    constexpr double slack = 1e-5;
    std::vector<Eigen::Index> open;
    for (Eigen::Index i = 0; i < J.cols(); ++i)
      if (tensions[i] > slack && tensions[i] < most_pull - slack) open.push_back(i);
    if (!result.is_least || open.size() < 4 || singular_values(J(Eigen::all, open))[2] < 1e-3 * J.norm())
      return;
    ++redundant;
    const Eigen::MatrixXd J_open = J(Eigen::all, open);
    const Eigen::VectorXd multipliers = pseudo_inverse(J_open).transpose() * tensions(open);
    const Eigen::VectorXd left = tensions - J.transpose() * multipliers;
    const double rounding = 1e-4 * tensions.norm();
    for (Eigen::Index i = 0; i < J.cols(); ++i) {
      EXPECT_TRUE(tensions[i] <= slack || left[i] <= rounding)
          << i << ": " << left[i] << " of " << tensions[i];
      EXPECT_TRUE(tensions[i] >= most_pull - slack || left[i] >= -rounding)
          << i << ": " << left[i] << " of " << tensions[i];
    }
  });
  EXPECT_GE(redundant, 10 / one_case_of);
  EXPECT_LE(missed, count / 100);
}

TEST(InverseStatics, TheKnownRobotNeedsLessThanHalfTheEffort) {
  RodStatics statics(two_section_robot());
  const Equilibrium made = statics.solve({.tensions = {4, 0, 0, 0, 2, 0}}, {});
  const InverseStaticsResult result =
      solve_inverse_statics(statics, {.position = made.tip.position}, {}, std::vector(6, 10.0));
  expect_reached(result, std::vector(6, 10.0));
  EXPECT_TRUE(result.is_least);
  EXPECT_LE(result.effort, 10);
  EXPECT_LE(result.evaluations, 30);
}

TEST(InverseStatics, DirectionsAndRotationsOfTheTipAreReached) {
  for_random_cases(40, [](TestRandom& random) {
    Made made(random, random.integer(0, 1) == 0);
    ASSERT_TRUE(made.at.converged());
    if (!made.at.stable) return;
    RodTarget target{.position = made.at.tip.position};
    if (random.integer(0, 1) == 0)
      target.direction = random.uniform(0.1, 3) * made.at.tip.rotation.col(2);
    else
      target.rotation = made.at.tip.rotation;
    const InverseStaticsResult result = solve_inverse_statics(made.statics, target, made.loads, made.most);
    expect_reached(result, made.most);
    EXPECT_LE(result.angle_error, 1e-7);
    const Eigen::Matrix3d turned = result.equilibrium.tip.rotation * made.at.tip.rotation.transpose();
    const double off = target.rotation
                           ? so3_log(turned).norm()
                           : (turned * made.at.tip.rotation.col(2)).cross(made.at.tip.rotation.col(2)).norm();
    EXPECT_NEAR(off, result.angle_error, 1e-9);
  });
}

TEST(InverseStatics, AShapeGivesBackTheTensionsThatMadeIt) {
  for_random_cases(20, [](TestRandom& random) {
    std::vector<RodPlace> places;
    for (const std::size_t section : {0u, 1u})
      for (const double at : {0.35, 0.7, 1.0}) places.push_back({.section = section, .at = at});
    const Rod rod = coarse(two_section_robot());
    RodStatics statics(rod, places);
    const RodLoads loads = random_loads(random, rod);
    const std::vector<double> tensions = random_tensions(random, rod, 4);
    const Equilibrium made = statics.solve({.tensions = tensions}, loads);
    ASSERT_TRUE(made.converged());
    if (!made.stable) return;
    RodTarget target;
    for (const RodPlace& place : places) {
      const RodElement& element = statics.chain().elements()[place.section];
      target.places.push_back({place, element.poses()[element.grid().node_at(place.at)].position});
    }
    const InverseStaticsResult result = solve_inverse_statics(statics, target, loads, all_of(rod, 10));
    expect_reached(result, all_of(rod, 10));
    for (std::size_t i = 0; i < tensions.size(); ++i) EXPECT_NEAR(result.tensions[i], tensions[i], 1e-3);
  });
}

TEST(InverseStatics, OutOfReachItComesAsNearAsAnyTensions) {
  Rod rod{.sections = {{.length = 0.3,
                        .radius = {1e-3, 1e-3},
                        .youngs_modulus = 50e9,
                        .shear_modulus = 20e9,
                        .density = 6000}},
          .tendons = {{.radius = 0.01}, {.radius = 0.01, .angle = std::numbers::pi}}};
  rod.sections[0].modes = {.shear = 1, .stretch = 1, .bend = 3, .twist = 0, .planar = true};
  RodStatics statics(rod);
  const RodLoads loads{.gravity = {5, 0, -8}};
  constexpr double most = 6;
  constexpr int steps = 60;
  std::vector<Eigen::Vector3d> tips;
  for (int a = 0; a <= steps; ++a)
    for (int b = 0; b <= steps; ++b)
      tips.push_back(statics.solve({.tensions = {most * a / steps, most * b / steps}}, loads).tip.position);
  for_random_cases(30, [&](TestRandom& random) {
    const Eigen::Vector3d desired(random.uniform(-0.4, 0.4), random.uniform(-0.05, 0.05),
                                  random.uniform(-0.2, 0.4));
    double best = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector3d& tip : tips) best = std::min(best, (tip - desired).norm());
    const InverseStaticsResult result =
        solve_inverse_statics(statics, {.position = desired}, loads, {most, most});
    ASSERT_EQ(result.end, InverseStaticsEnd::nearest);
    EXPECT_FALSE(result.reached() || result.is_least || result.problem.empty());
    EXPECT_NEAR((result.equilibrium.tip.position - desired).norm(), result.position_error, 1e-12);
    EXPECT_LE(result.position_error, best + 1e-7);
    EXPECT_GE(result.position_error, best - 2e-3);
  });
}

TEST(InverseStatics, AShortPullSaysThatBoundsHoldIt) {
  RodStatics statics(two_section_robot());
  const Equilibrium made = statics.solve({.tensions = {4, 0, 0, 0, 2, 0}}, {});
  const InverseStaticsResult result =
      solve_inverse_statics(statics, {.position = made.tip.position}, {}, std::vector(6, 0.5));
  EXPECT_EQ(result.end, InverseStaticsEnd::nearest);
  EXPECT_NE(result.problem.find("bounds"), std::string::npos) << result.problem;
  EXPECT_EQ(std::ranges::max(result.tensions), 0.5);
}

TEST(InverseStatics, AnEquilibriumThatDoesNotLastIsNotReached) {
  // Twice the buckling load of L. Euler, along the rod.
  RodStatics statics(two_section_robot());
  const RodLoads loads{.ends = {{.section = 1, .force = {0, 0, -0.3}}}};
  const Equilibrium straight = statics.solve({}, loads);
  ASSERT_TRUE(straight.converged() && !straight.stable);
  const InverseStaticsResult result = solve_inverse_statics(statics, {.position = straight.tip.position},
                                                            loads, std::vector(6, 10.0), {.max_starts = 1});
  EXPECT_EQ(result.end, InverseStaticsEnd::nearest);
  EXPECT_NE(result.problem.find("not stable"), std::string::npos) << result.problem;
}

TEST(InverseStatics, TendonsThatMayNotPullAreLeftOut) {
  RodStatics statics(two_section_robot());
  const Equilibrium made = statics.solve({.tensions = {2, 0, 0, 1, 1, 0}}, {});
  const std::vector<double> most = {10, 0, 0, 10, 10, 10};
  const InverseStaticsResult result =
      solve_inverse_statics(statics, {.position = made.tip.position}, {}, most);
  expect_reached(result, most);
}

TEST(InverseStatics, ATargetThatMovesIsFollowedWithFewEquilibria) {
  RodStatics statics(two_section_robot());
  const RodLoads loads{.gravity = {0, -9.81, 0}, .ends = {{.section = 1, .force = {0, 0.02, 0}}}};
  const std::vector<double> most(6, 10);
  Equilibrium at = statics.solve({.tensions = {2, 1, 0, 0, 2, 0}}, loads);
  const Eigen::Vector3d from = at.tip.position;
  int evaluations = 0;
  constexpr int steps = 40;
  for (int i = 1; i <= steps; ++i) {
    const RodTarget target{.position = from + 0.03 * i / steps * Eigen::Vector3d(1, -1, -0.5)};
    const InverseStaticsResult result = solve_inverse_statics(statics, target, loads, most, {.start = at});
    expect_reached(result, most);
    EXPECT_TRUE(result.is_least);
    EXPECT_EQ(result.starts, 1);
    evaluations += result.evaluations;
    at = result.equilibrium;
  }
  EXPECT_LE(evaluations, 14 * steps);
}

TEST(InverseStatics, TheSameQuestionHasTheSameAnswer) {
  const RodTarget target{.position = Eigen::Vector3d(0.1, 0.12, 0.34)};
  RodStatics statics(two_section_robot());
  const InverseStaticsResult one = solve_inverse_statics(statics, target, {}, std::vector(6, 10.0));
  (void)statics.solve({.tensions = {1, 2, 3, 4, 5, 6}}, {});
  const InverseStaticsResult two = solve_inverse_statics(statics, target, {}, std::vector(6, 10.0));
  EXPECT_EQ(one.tensions, two.tensions);
  EXPECT_EQ(one.evaluations, two.evaluations);
}

TEST(InverseStatics, BadInputIsAResult) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  RodStatics statics(two_section_robot());
  const Eigen::Vector3d p(0, 0, 0.3);
  const std::vector<double> most(6, 5);
  const auto expect_bad = [&](const RodTarget& target, const RodLoads& loads,
                              const std::vector<double>& bounds, const InverseStaticsConfig& config = {}) {
    const InverseStaticsResult result = solve_inverse_statics(statics, target, loads, bounds, config);
    EXPECT_EQ(result.end, InverseStaticsEnd::bad_input);
    EXPECT_FALSE(result.problem.empty());
    EXPECT_TRUE(result.tensions.empty());
    EXPECT_FALSE(result.reached() || result.is_least);
  };
  expect_bad({}, {}, most);
  expect_bad({.position = Eigen::Vector3d(0, nan, 0)}, {}, most);
  expect_bad({.direction = Eigen::Vector3d(0, 0, 0)}, {}, most);
  expect_bad({.direction = Eigen::Vector3d(0, nan, 1)}, {}, most);
  expect_bad({.direction = p, .rotation = Eigen::Matrix3d::Identity()}, {}, most);
  expect_bad({.rotation = -Eigen::Matrix3d::Identity()}, {}, most);
  expect_bad({.rotation = nan * Eigen::Matrix3d::Identity()}, {}, most);
  expect_bad({.position = p, .angle_weight = 0}, {}, most);
  expect_bad({.position = p, .angle_weight = nan}, {}, most);
  expect_bad({.places = {{{.section = 2, .at = 1}, p}}}, {}, most);
  expect_bad({.places = {{{.section = 1, .at = 1.2}, p}}}, {}, most);
  expect_bad({.places = {{{.section = 1, .at = nan}, p}}}, {}, most);
  expect_bad({.places = {{{.section = 1, .at = 0.123}, p}}}, {}, most);  // Not a node.
  expect_bad({.places = {{{.section = 1, .at = 1}, nan * p}}}, {}, most);
  expect_bad({.position = p}, {}, std::vector(5, 5.0));
  expect_bad({.position = p}, {}, {5, 5, 5, 5, 5, -1});
  expect_bad({.position = p}, {}, {5, 5, 5, 5, 5, nan});
  expect_bad({.position = p}, {}, {5, 5, 5, 5, 5, std::numeric_limits<double>::infinity()});
  expect_bad({.position = p}, {.gravity = {nan, 0, 0}}, most);
  expect_bad({.position = p}, {.ends = {{.section = 7}}}, most);
  expect_bad({.position = p}, {}, most, {.tolerance = 0});
  expect_bad({.position = p}, {}, most, {.tolerance = nan});
  expect_bad({.position = p}, {}, most, {.max_starts = 0});
  Equilibrium other;
  expect_bad({.position = p}, {}, most, {.start = other});
  other.tensions.assign(6, nan);
  expect_bad({.position = p}, {}, most, {.start = other});
  RodStatics bare(elastica(3));
  EXPECT_EQ(solve_inverse_statics(bare, {.position = p}, {}, {}).end, InverseStaticsEnd::bad_input);
}

TEST(InverseStatics, WhereNoTendonMayPullItStaysAtRest) {
  RodStatics statics(two_section_robot());
  const InverseStaticsResult result =
      solve_inverse_statics(statics, {.position = Eigen::Vector3d(0.1, 0, 0.3)}, {}, std::vector(6, 0.0));
  EXPECT_EQ(result.end, InverseStaticsEnd::nearest);
  EXPECT_NEAR(result.position_error, std::hypot(0.1, 0.1), 1e-9);
  EXPECT_EQ(result.effort, 0);
}

}  // namespace
}  // namespace flexura
