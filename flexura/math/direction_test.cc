#include "flexura/math/direction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(Direction, AnglesAndVectorTellTheSame) {
  for_random_cases(200, [](TestRandom& random) {
    const Eigen::Vector3d e = random.vector<3>(-1, 1).normalized();
    const double size = random.uniform(0.1, 10);
    EXPECT_LT((direction_of_angles(angles_of_direction(size * e)) - e).norm(), 1e-15);
    const Eigen::Vector2d angles(random.uniform(-3.1, 3.1), random.uniform(-1.5, 1.5));
    EXPECT_LT((angles_of_direction(direction_of_angles(angles)) - angles).norm(), 1e-13);
    EXPECT_NEAR(direction_of_angles(angles).norm(), 1, 1e-15);
  });
}

// The paper's axes: Y along the arm, X to the side, Z towards the first camera.
TEST(Direction, CountsFromY) {
  EXPECT_EQ(angles_of_direction({0, 1, 0}), Eigen::Vector2d(0, 0));
  EXPECT_NEAR((angles_of_direction({1, 0, 0}) - Eigen::Vector2d(std::numbers::pi / 2, 0)).norm(), 0, 1e-15);
  EXPECT_NEAR((angles_of_direction({0, 0, 2}) - Eigen::Vector2d(0, std::numbers::pi / 2)).norm(), 0, 1e-15);
}

TEST(Direction, IsToldByItsImagesInTwoPlanes) {
  for_random_cases(200, [](TestRandom& random) {
    const Eigen::Vector2d angles(random.uniform(-3.1, 3.1), random.uniform(-1.5, 1.5));
    const Eigen::Vector3d e = direction_of_angles(angles);
    const double alpha_1 = std::atan2(e.x(), e.y()), alpha_2 = std::atan2(e.z(), e.y());
    EXPECT_NEAR(elevation_of_planes(alpha_1, alpha_2), angles[1], 1e-9);
    const double off = std::abs(std::abs(std::remainder(angles[0], std::numbers::pi)) - std::numbers::pi / 2);
    EXPECT_EQ(is_singular_for_planes(angles[0]), off < std::numbers::pi / 18);
  });
}

TEST(Direction, NearestTurnIsWithinHalfATurnAndWholeTurnsAway) {
  for_random_cases(200, [](TestRandom& random) {
    const double angle = random.uniform(-50, 50), other = random.uniform(-50, 50);
    const double moved = nearest_turn(angle, other);
    EXPECT_LE(std::abs(moved - other), std::numbers::pi + 1e-12);
    const double turns = (moved - angle) / (2 * std::numbers::pi);
    EXPECT_NEAR(turns, std::round(turns), 1e-12);
  });
}

}  // namespace
}  // namespace flexura
