#include "flexura/vision/etalon_finder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "flexura/vision/picture_file.h"
#include "tests/support/seen_arms.h"

namespace flexura {
namespace {

constexpr double radius = 0.1, height = 0.4, focal_length = 800;

// The cylinder `turned` about its axis, seen from a camera level with its middle, `aside` from straight
// ahead.
struct SeenEtalon {
  Scene scene;
  View view;
  Image<std::uint8_t> picture;
};
SeenEtalon seen_etalon(double turned, double distance, double aside, std::uint64_t seed) {
  SeenEtalon seen;
  seen.scene.background = Color::Constant(0.85);
  Etalon& etalon = seen.scene.etalon.emplace();
  etalon.radius = radius, etalon.height = height;
  etalon.X_WE.rotation = Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitY()).toRotationMatrix();
  etalon.X_WE.position = {aside, 0, 0};
  seen.view = pinhole_view(look_at({0, 0, distance}, {0, 0, 0}), 640, 480, focal_length);
  SeenArmConfig options;
  options.color = true, options.noise = 1;
  seen.picture = photograph(seen.scene, seen.view, options, seed);
  return seen;
}

TEST(FindEtalon, HasSidesAndLinesWhereTheRendererDrawsThem) {
  for_random_cases(12, [](TestRandom& random) {
    const double turned = random.uniform(-0.7, 0.7), distance = random.uniform(1.2, 2.2),
                 aside = random.uniform(-0.15, 0.15);
    const SeenEtalon seen =
        seen_etalon(turned, distance, aside, static_cast<std::uint64_t>(random.integer(0, 1 << 30)));
    const EtalonObservation found = find_etalon(seen.picture, gray_picture(seen.picture));
    ASSERT_EQ(found.reason, "");
    // Tangents from the camera to the cylinder.
    const double bearing = std::atan2(aside, distance),
                 half = std::asin(radius / std::hypot(aside, distance));
    const double middle = 0.5 * (seen.view.width - 1);
    const double left = middle + focal_length * std::tan(bearing - half),
                 right = middle + focal_length * std::tan(bearing + half);
    EXPECT_NEAR(found.left.at, left, 0.06);
    EXPECT_NEAR(found.right.at, right, 0.06);
    EXPECT_NEAR(found.left.slope, 0, 1e-3);
    EXPECT_FALSE(found.touches_border);
    // The line that faces the camera most; its neighbours may be hidden.
    std::vector<double> lines;
    for (int i = 0; i < 4; ++i) {
      const double angle = turned + i * std::numbers::pi / 2;
      const Eigen::Vector2d at(aside + radius * std::sin(angle), distance - radius * std::cos(angle));
      const Eigen::Vector2d outward(std::sin(angle), -std::cos(angle));
      if (outward.dot(at.normalized()) < -0.5) lines.push_back(middle + focal_length * at.x() / at.y());
    }
    std::ranges::sort(lines);
    ASSERT_GE(found.lines.size(), lines.size());
    for (const double line : lines) {
      const auto nearest = std::ranges::min_element(
          found.lines, {}, [&](const UprightLine& one) { return std::abs(one.at - line); });
      EXPECT_NEAR(nearest->at, line, 0.25);
    }
  });
}

TEST(FindEtalon, SaysThatThePicturesBorderCutsIt) {
  const SeenEtalon seen = seen_etalon(0.1, 1.3, 0.5, 1);
  const EtalonObservation found = find_etalon(seen.picture, gray_picture(seen.picture));
  EXPECT_TRUE(found.touches_border || !found.reason.empty());
}

}  // namespace
}  // namespace flexura
