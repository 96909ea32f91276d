#include "flexura/math/nearest_point.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

Eigen::VectorXd vector_of(TestRandom& random, Eigen::Index size, double most) {
  Eigen::VectorXd x(size);
  for (double& value : x) value = random.uniform(-most, most);
  return x;
}

// Limits with the origin inside.
ConvexLimits limits_of(TestRandom& random, Eigen::Index size) {
  ConvexLimits limits;
  for (Eigen::Index at = 0; at + 2 <= size; at += 2) {
    const Eigen::VectorXd center = vector_of(random, 2, 0.3);
    limits.balls.push_back({at, center, center.norm() + random.uniform(0.1, 1)});
  }
  const int bands = random.integer(0, 6);
  for (int i = 0; i < bands; ++i)
    limits.bands.push_back({vector_of(random, size, 2), -random.uniform(0.05, 1), random.uniform(0.05, 1)});
  return limits;
}

// The nearest point of a convex set: every other point of the set lies on the far side of the plane through
// it, perpendicular to the way from x.
TEST(NearestPoint, IsWithinTheLimitsAndNoOtherIsNearer) {
  for_random_cases(200, [](TestRandom& random) {
    const Eigen::Index size = random.integer(1, 9);
    const ConvexLimits limits = limits_of(random, size);
    const Eigen::VectorXd x = vector_of(random, size, 3);
    const auto nearest = nearest_point(limits, x, {.most_rounds = 20000});
    ASSERT_TRUE(nearest);
    EXPECT_LE(excess(limits, *nearest), 1e-7);
    for (int i = 0; i < 20; ++i) {
      const auto other = nearest_point(limits, vector_of(random, size, 3), {.most_rounds = 20000});
      ASSERT_TRUE(other);
      EXPECT_LE((x - *nearest).dot(*other - *nearest), 1e-5);
    }
    // A point within the limits is its own nearest point.
    EXPECT_LE((*nearest_point(limits, 0.999 * *nearest) - 0.999 * *nearest).norm(), 1e-6);
  });
}

TEST(NearestPoint, AgreesWithClosedForms) {
  const ConvexLimits ball{.balls = {{0, Eigen::Vector2d(1, 0), 2}}, .bands = {}};
  EXPECT_LE((*nearest_point(ball, Eigen::Vector3d(1, 5, 7)) - Eigen::Vector3d(1, 2, 7)).norm(), 1e-6);
  const ConvexLimits corner{.balls = {},
                            .bands = {{Eigen::Vector2d(2, 0), -1, 1}, {Eigen::Vector2d(1, 1), -9, 1}}};
  EXPECT_LE((*nearest_point(corner, Eigen::Vector2d(5, 5)) - Eigen::Vector2d(0.5, 0.5)).norm(), 1e-6);
}

TEST(NearestPoint, IsEmptyWhereLimitsContradict) {
  const ConvexLimits apart{
      .balls = {{0, Eigen::VectorXd::Constant(1, 0), 1}, {0, Eigen::VectorXd::Constant(1, 5), 1}},
      .bands = {}};
  EXPECT_FALSE(nearest_point(apart, Eigen::VectorXd::Zero(1)));
  EXPECT_THROW((void)nearest_point(apart, Eigen::VectorXd()), std::invalid_argument);
  EXPECT_FALSE(nearest_point(ConvexLimits{.balls = {{0, Eigen::VectorXd::Constant(1, 0), 1}}, .bands = {}},
                             Eigen::VectorXd::Constant(1, std::nan(""))));
}

}  // namespace
}  // namespace flexura
