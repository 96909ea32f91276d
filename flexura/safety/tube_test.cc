#include "flexura/safety/tube.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/arms.h"

namespace flexura {
namespace {

using std::numbers::pi;

SectionTube tube_at(const Eigen::Vector3d& position, const Eigen::Vector2d& bend, double length,
                    double radius) {
  return {{Eigen::Matrix3d::Identity(), position}, bend, length, {radius, radius}, 0};
}

// Returns the distance between the tubes at u and v. If the turn between them is too small, v moves to where
// it just suffices.
double distance_at(const SectionTube& a, const SectionTube& b, double least_turn, double u, double v) {
  const double missing = a.turn_at(u) + least_turn - b.turn_at(v);
  if (missing > 0) v += b.bend.norm() > 0 ? missing / b.bend.norm() : 2;
  if (v > 1) return no_distance;
  return (a.point(u) - b.point(v)).norm() - a.radius_at(u) - b.radius_at(v);
}

// Descends from (u, v) with decreasing steps.
double descended(const SectionTube& a, const SectionTube& b, double least_turn, double u, double v,
                 double step) {
  constexpr int ways = 16;
  double best = distance_at(a, b, least_turn, u, v);
  for (double h = step; h > 1e-11;) {
    const double before = best;
    for (int k = 0; k < ways; ++k) {
      const double x = std::clamp(u + h * std::cos(2 * pi * k / ways), 0.0, 1.0);
      const double y = std::clamp(v + h * std::sin(2 * pi * k / ways), 0.0, 1.0);
      const double now = distance_at(a, b, least_turn, x, y);
      if (now < best) best = now, u = x, v = y;
    }
    if (best == before) h /= 2;
  }
  return best;
}

// Brute force: a grid, and a descent from every local minimum of it.
double brute_force(const SectionTube& a, const SectionTube& b, double least_turn) {
  constexpr int n = 60;
  std::vector<double> grid;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j)
      grid.push_back(distance_at(a, b, least_turn, static_cast<double>(i) / n, static_cast<double>(j) / n));
  }
  const auto at = [&](int i, int j) {
    const auto row = static_cast<std::size_t>(std::clamp(i, 0, n));
    return grid[row * static_cast<std::size_t>(n + 1) + static_cast<std::size_t>(std::clamp(j, 0, n))];
  };
  double best = no_distance;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      if (at(i, j) > std::min({at(i - 1, j), at(i + 1, j), at(i, j - 1), at(i, j + 1)})) continue;
      if (at(i, j) == no_distance) continue;
      best = std::min(
          best, descended(a, b, least_turn, static_cast<double>(i) / n, static_cast<double>(j) / n, 1.0 / n));
    }
  }
  return best;
}

void expect_as_brute_force(const SectionTube& a, const SectionTube& b, double least_turn) {
  const double expected = brute_force(a, b, least_turn);
  const double found = tube_distance(a, b, {least_turn});
  if (expected == no_distance) return;  // The grid may miss a sliver of pairs.
  EXPECT_LE(found, expected + 1e-6);
  EXPECT_GE(found, expected - 1e-6);  // Brute force may stay above the least.
}

TEST(TubeDistance, IsThatOfBruteForce) {
  for_random_cases(40, [](TestRandom& random) {
    Arm arm = random_arm(random);
    for (Section& section : arm.sections)
      section.radius = {random.uniform(0.01, 0.1), random.uniform(0.01, 0.1)};
    const std::vector<SectionTube> tubes = tube_arcs(arm, random_state(random, arm));
    const auto last = static_cast<int>(tubes.size()) - 1;
    const auto i = static_cast<std::size_t>(random.integer(0, last));
    const auto j = static_cast<std::size_t>(random.integer(static_cast<int>(i), last));
    expect_as_brute_force(tubes[i], tubes[j], pi);
    if (i != j) expect_as_brute_force(tubes[i], tubes[j], -1);
  });
}

// Returns the least distance over a grid of pairs that count by the rule.
double least_of_grid(const SectionTube& a, const SectionTube& b, const PairRule& rule, int n) {
  double least = no_distance;
  for (int i = 0; i <= n; ++i) {
    const double u = static_cast<double>(i) / n;
    for (int j = 0; j <= n; ++j) {
      const double v = static_cast<double>(j) / n;
      const double gap = b.arc_at(v) - a.arc_at(u) - pi / 2 * (a.radius_at(u) + b.radius_at(v));
      if (b.turn_at(v) - a.turn_at(u) < rule.turn && gap < rule.gap) continue;
      least = std::min(least, (a.point(u) - b.point(v)).norm() - a.radius_at(u) - b.radius_at(v));
    }
  }
  return least;
}

TEST(TubeDistance, CountsWhatIsFarAlongTheArmToo) {
  for_random_cases(60, [](TestRandom& random) {
    Arm arm = random_arm(random);
    for (Section& section : arm.sections)
      section.radius = {random.uniform(0.01, 0.1), random.uniform(0.01, 0.1)};
    const std::vector<SectionTube> tubes = tube_arcs(arm, random_state(random, arm));
    const auto last = static_cast<int>(tubes.size()) - 1;
    const SectionTube& a = tubes[static_cast<std::size_t>(random.integer(0, last))];
    for (const SectionTube& b : tubes) {
      if (b.start < a.start) continue;
      const PairRule rule{pi, random.uniform(-0.01, 0.01)};
      const double found = tube_distance(a, b, rule);
      const double sampled = least_of_grid(a, b, rule, 200);
      EXPECT_LE(found, sampled + 1e-6);
      EXPECT_GE(found, sampled - 2 * (a.length + b.length) / 200);
      if (found == no_distance) continue;
      EXPECT_FALSE(stay_apart(a, b, rule, found + 1e-5));
      EXPECT_FALSE(come_within(a, b, rule, found - 1e-5));
    }
  });
}

TEST(TubeDistance, OfParallelAndCrossingStraightTubesIsExact) {
  const SectionTube a = tube_at({0, 0, 0}, {0, 0}, 1, 0.1);
  EXPECT_NEAR(tube_distance(a, tube_at({0.5, 0, 0.2}, {0, 0}, 1, 0.1), {-1}), 0.3, 1e-12);
  EXPECT_NEAR(tube_distance(a, tube_at({0, 0, 1.5}, {0, 0}, 1, 0.1), {-1}), 0.3, 1e-12);
  EXPECT_NEAR(tube_distance(a, tube_at({0.5, 0, 0}, {1e-9, 0}, 1, 0.1), {-1}), 0.3, 1e-6);
}

TEST(TubeDistance, OfAHalfTurnIsTheDiameter) {
  const SectionTube half = tube_at({0, 0, 0}, {pi, 0}, pi, 0.25);  // Radius of curvature 1.
  EXPECT_NEAR(tube_distance(half, half, {pi - 1e-9}), 1.5, 1e-6);
  EXPECT_EQ(tube_distance(half, half, {pi + 1e-9}), no_distance);
}

TEST(TubeDistance, OfAFullCircleIsItsOverlap) {
  for (const double bend : {2 * pi, 2.5 * pi, 4 * pi}) {
    const SectionTube circle = tube_at({0, 0, 0}, {0, bend}, 1, 0.01);
    EXPECT_NEAR(tube_distance(circle, circle, {pi}), -0.02, 1e-6) << bend;
  }
  const SectionTube open = tube_at({0, 0, 0}, {1.9 * pi, 0}, 1.9 * pi, 0.01);
  EXPECT_NEAR(tube_distance(open, open, {pi}), 2 * std::sin(0.05 * pi) - 0.02, 1e-6);
}

TEST(TubeDistance, StopsWhereItsQuestionIsAnswered) {
  const SectionTube a = tube_at({0, 0, 0}, {1, 0}, 1, 0.1);
  const SectionTube b = tube_at({0.7, 0.3, 0}, {-1, 2}, 1, 0.1);
  const double exact = tube_distance(a, b, {-100});
  EXPECT_EQ(tube_distance(a, b, {-100}, {.cap = exact - 1e-3}), exact - 1e-3);
  EXPECT_LT(tube_distance(a, b, {-100}, {.enough = exact + 1e-3}), exact + 1e-3);
  EXPECT_TRUE(stay_apart(a, b, {-100}, exact - 1e-5));
  EXPECT_FALSE(stay_apart(a, b, {-100}, exact + 1e-5));
  EXPECT_TRUE(come_within(a, b, {-100}, exact + 1e-5));
  EXPECT_FALSE(come_within(a, b, {-100}, exact - 1e-5));
}

std::vector<Obstacle> random_obstacles(TestRandom& random) {
  const auto place = [&] {
    const Eigen::Vector3d p = random.vector<3>(-2, 2);
    return std::array{p.x(), p.y(), p.z()};
  };
  const Eigen::Quaterniond q(so3_exp(random.vector<3>(-2, 2)));
  return obstacles(
      {PlaneConfig{.point = place(), .normal = place()},
       SphereConfig{.center = place(), .radius = random.uniform(0.1, 1)},
       CapsuleConfig{.from = place(), .to = place(), .radius = random.uniform(0.1, 0.5)},
       BoxConfig{.center = place(),
                 .half_sizes = {random.uniform(0.1, 1), random.uniform(0.1, 1), random.uniform(0.1, 1)},
                 .rotation = {q.w(), q.x(), q.y(), q.z()}}});
}

TEST(ObstacleDistance, IsThatOfBruteForce) {
  for_random_cases(100, [](TestRandom& random) {
    SectionTube tube = tube_at(random.vector<3>(-2, 2), random.vector<2>(-5, 5), random.uniform(0.2, 3), 0);
    tube.radius = {random.uniform(0.01, 0.2), random.uniform(0.01, 0.2)};
    const double from = random.uniform(0, 0.5);
    for (const Obstacle& obstacle : random_obstacles(random)) {
      double expected = no_distance;
      double where = 0;
      const auto at = [&](double u) { return obstacle.distance(tube.point(u)) - tube.radius_at(u); };
      for (int k = 0; k <= 2000; ++k) {
        const double u = from + (1 - from) * k / 2000;
        if (at(u) < expected) expected = at(u), where = u;
      }
      for (double h = 1e-3; h > 1e-10; h /= 2) {
        for (const double u : {where - h, where + h}) {
          if (u >= from && u <= 1 && at(u) < expected) expected = at(u), where = u;
        }
      }
      EXPECT_NEAR(obstacle_distance(tube, from, obstacle, {}), expected, 1e-6) << obstacle.name;
    }
  });
}

TEST(ObstacleDistance, OfWhatLiesFlatOnABoxIsSoonProved) {
  // Without the bound by sides, chords and arcs would have to agree to a part of a micrometre.
  const Obstacle table = obstacles({BoxConfig{.center = {0, 0, -0.05}, .half_sizes = {2, 2, 0.05}}}).front();
  const Eigen::Matrix3d along = so3_exp({0, pi / 2, 0});
  for (const double gap : {0.0, 1e-7, -1e-5, -0.01}) {
    const SectionTube flat{{along, {0, 0, 0.02 + gap}}, {0, 2}, 0.3, {0.02, 0.02}, 0};
    EXPECT_NEAR(obstacle_distance(flat, 0, table, {}), gap, 1e-9);
    EXPECT_TRUE(stays_clear(flat, 0, table, gap - 1e-9));
    EXPECT_TRUE(comes_within(flat, 0, table, gap + 1e-6));
  }
}

TEST(ObstacleDistance, CountsFromTheFractionOnAndAlongAPlane) {
  const Obstacle ground = obstacles({PlaneConfig{.normal = {3, 0, 0}}}).front();
  const SectionTube along = tube_at({0.5, 0, 0}, {0, 0}, 1, 0.1);
  EXPECT_NEAR(obstacle_distance(along, 0, ground, {}), 0.4, 1e-6);
  const SectionTube away = tube_at({0, 0, 0}, {pi, 0}, pi, 0.1);
  EXPECT_NEAR(obstacle_distance(away, 0, ground, {}), -0.1, 1e-6);
  EXPECT_NEAR(obstacle_distance(away, 0.5, ground, {}), 1 - 0.1, 1e-6);
  EXPECT_EQ(obstacle_distance(away, 1.5, ground, {}), no_distance);
}

TEST(Obstacle, DistancesOfABoxAreThoseOfItsFacesEdgesAndCorners) {
  const Obstacle box = obstacles({BoxConfig{.name = "desk", .half_sizes = {1, 2, 3}}}).front();
  EXPECT_EQ(box.name, "desk");
  EXPECT_DOUBLE_EQ(box.distance({0, 0, 0}), -1);
  EXPECT_NEAR(box.distance({0.9, 0, 2.95}), -0.05, 1e-12);
  EXPECT_DOUBLE_EQ(box.distance({4, 0, 0}), 3);
  EXPECT_DOUBLE_EQ(box.distance({4, 6, 0}), 5);
  EXPECT_DOUBLE_EQ(box.distance({2, 4, 5}), 3);
}

}  // namespace
}  // namespace flexura
