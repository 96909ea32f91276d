#include "flexura/vision/curve_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "tests/support/seen_arms.h"

namespace flexura {
namespace {

std::vector<AxisSample> line(double angle, double shift) {
  std::vector<AxisSample> axis;
  const Eigen::Vector2d tangent(std::cos(angle), std::sin(angle)), normal(-tangent.y(), tangent.x());
  for (int i = 0; i < 100; ++i) {
    AxisSample& sample = axis.emplace_back();
    sample.pixel = Eigen::Vector2d(200, 200) + i * tangent + shift * normal;
    sample.normal = normal, sample.width = 12, sample.is_seen = true;
  }
  return axis;
}

TEST(CurveFlow, TellsTheMotionAlongTheNormalAndTheTurn) {
  const auto before = line(0.3, 0);
  const CurveFlow moved = curve_flow(before, line(0.3, 1.7));
  EXPECT_NEAR(moved.normal[50], 1.7, 1e-9);
  EXPECT_NEAR(moved.turn[50], 0, 1e-9);
  const CurveFlow turned = curve_flow(before, line(0.35, 0));
  EXPECT_NEAR(turned.turn[50], 0.05, 1e-9);
  EXPECT_NEAR(turned.normal[50], 50 * std::tan(0.05), 1e-6);
  EXPECT_TRUE(std::isnan(curve_flow(before, line(0.3, 30)).normal[50]));
}

TEST(CurveFlow, OfMarkersIsThatOfThePicture) {
  SeenArmOptions options;
  options.width = 320, options.height = 240;
  TestRandom random(7);
  SeenArm seen = random_seen_arm(random, options);
  Image<std::uint8_t> moved = seen.picture;
  for (int v = 0; v < 240; ++v)
    for (int u = 0; u < 320; ++u)
      moved.at(u, v) = seen.picture.at(std::clamp(u - 3, 0, 319), std::clamp(v + 2, 0, 239));
  // At the arm's tip the picture has texture in both directions.
  const std::vector<Eigen::Vector2d> places = {*seen.truth.back().pixel};
  for (const FlowMethod method : {FlowMethod::lucas_kanade, FlowMethod::dis}) {
    const auto flow = flow_at(seen.picture, moved, places, method);
    ASSERT_TRUE(flow[0]);
    EXPECT_LT((*flow[0] - Eigen::Vector2d(3, -2)).norm(), 0.5) << static_cast<int>(method);
  }
  EXPECT_THROW((void)flow_at(seen.picture, Image<std::uint8_t>(3, 3), places), std::invalid_argument);
}

TEST(AngleIntegrator, DriftsUntilItIsAnchored) {
  AngleIntegrator angles({0, 0, 0});
  for (int i = 0; i < 10; ++i)
    angles.add(std::vector<double>{0.1, std::numeric_limits<double>::quiet_NaN(), 0.3});
  EXPECT_NEAR(angles.angles()[1], 2, 1e-12);
  EXPECT_NEAR(angles.anchor(std::vector<double>{1.1, 2, 3 - 2 * 3.14159265358979}), 0.1 / std::sqrt(3.0),
              1e-9);
  EXPECT_NEAR(angles.angles()[0], 1.1, 1e-12);
  EXPECT_NEAR(angles.angles()[2], 3, 1e-9);
}

}  // namespace
}  // namespace flexura
