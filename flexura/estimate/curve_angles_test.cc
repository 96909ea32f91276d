#include "flexura/estimate/curve_angles.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "flexura/base/degree.h"
#include "tests/support/observations.h"
#include "tests/support/random_cases.h"

namespace flexura {
namespace {

TEST(DirectionAngles, GiveTheTangentBack) {
  for_random_cases(50, [](TestRandom& random) {
    const Arm arm = three_section_arm();
    const Backbone backbone(arm, random_bends(random, arm, 2.5));
    const auto angles = direction_angles(backbone, 101);
    for (std::size_t i = 0; i < angles.size(); ++i) {
      const auto [a, q, is_singular] = angles[i];
      const Eigen::Vector3d e(std::sin(a) * std::cos(q), std::cos(a) * std::cos(q), std::sin(q));
      const Eigen::Vector3d tangent =
          backbone.pose(0.01 * static_cast<double>(i) * backbone.length()).rotation.col(2);
      EXPECT_NEAR((e - tangent).norm(), 0, 1e-12);
      if (i > 0 && std::abs(q) < 1) {
        EXPECT_LT(std::abs(a - angles[i - 1].azimuth), 0.3);
      }
    }
  });
}

TEST(DirectionAngles, OfTwoPlanesAreThoseOfParallelProjections) {
  for_random_cases(200, [](TestRandom& random) {
    const double a = random.uniform(-3, 3), q = random.uniform(-1.4, 1.4);
    const Eigen::Vector3d e(std::sin(a) * std::cos(q), std::cos(a) * std::cos(q), std::sin(q));
    const DirectionAngles found = angles_of_planes(std::atan2(e.x(), e.y()), std::atan2(e.z(), e.y()));
    EXPECT_NEAR(found.azimuth, a, 1e-12);
    EXPECT_NEAR(found.elevation, q, 1e-9);
    EXPECT_EQ(found.is_singular, std::abs(std::cos(a)) < std::cos(80 * degree));
  });
}

TEST(DirectionAngles, OfTwoPicturesComeNearAsTheCamerasGoFar) {
  const Arm arm = three_section_arm();
  ArmState state = ArmState::straight(3);
  state.bends = {{0.3, 0.4}, {-0.2, 0.3}, {0.2, -0.5}};
  const Backbone backbone(arm, state);
  const auto exact = direction_angles(backbone, 51);
  std::vector<double> largest;
  for (const double distance : {5.0, 500.0}) {
    TestRandom random(1);
    std::vector<Observation> seen;
    for (View view : two_views(distance)) {
      view.lens = Lens({.fx = 320 * distance, .fy = 320 * distance});
      seen.push_back(observation_of(backbone, view, random, 0, {0, 1}, 400));
    }
    const auto found = plane_angles(seen[0], seen[1], 51);
    ASSERT_EQ(found.size(), 51U);
    double most = 0;
    for (std::size_t i = 2; i + 2 < found.size(); ++i) {
      EXPECT_FALSE(found[i].is_singular);
      most = std::max({most, std::abs(found[i].azimuth - exact[i].azimuth),
                       std::abs(found[i].elevation - exact[i].elevation)});
    }
    largest.push_back(most);
  }
  EXPECT_GT(largest[0], 0.5 * degree);
  EXPECT_LT(largest[0], 5 * degree);
  EXPECT_LT(largest[1], 0.3 * degree);
}

}  // namespace
}  // namespace flexura
