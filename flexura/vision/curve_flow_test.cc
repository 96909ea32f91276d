#include "flexura/vision/curve_flow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "tests/support/seen_arms.h"

namespace flexura {
namespace {

// An arm with bands at two instants: before, and bent a little more.
struct SeenArms {
  SeenArm before, after;
  std::vector<Eigen::Vector2d> bands;  // Positions of their middles before.
  std::vector<Eigen::Vector2d> moved;  // Motions of these positions.
};
SeenArms bent_on() {
  const auto seen_at = [](double bend) {
    SeenArm seen;
    BentArm bent;
    bent.arm.kind = ArmKind::spatial;
    bent.arm.sections.resize(2, {.length = 0.4, .radius = {0.02, 0.02}});
    bent.state = ArmState::straight(2);
    bent.state.bends = {{0.2, bend}, {-0.3, -bend}};
    seen.scene.background = Color::Constant(0.85);
    seen.scene.arm.tube = tube_of(bent.backbone());
    for (double s = 0.08; s < 0.78; s += 0.1)
      seen.scene.arm.markers.push_back({s - 0.01, s + 0.01, Color::Constant(0.6)});
    seen.view = pinhole_view(look_at({0, 0.4, 1.6}, {0, 0.4, 0}), 640, 480, 800);
    seen.picture = photograph(seen.scene, seen.view, {.noise = 1}, bend > 0.5 ? 2 : 1);
    return seen;
  };
  SeenArms arms{seen_at(0.5), seen_at(0.54), {}, {}};
  Renderer before, after;
  before.prepare(arms.before.scene, arms.before.view);
  after.prepare(arms.after.scene, arms.after.view);
  const auto from = marker_views(before), to = marker_views(after);
  for (std::size_t i = 0; i < from.size(); ++i) {
    arms.bands.push_back(*from[i].center.pixel);
    arms.moved.emplace_back(*to[i].center.pixel - *from[i].center.pixel);
  }
  return arms;
}

TEST(CurveFlow, OfBandsIsTheirMotion) {
  const SeenArms arms = bent_on();
  double largest = 0;
  for (const Eigen::Vector2d& way : arms.moved) largest = std::max(largest, way.norm());
  ASSERT_GT(largest, 2);
  const auto flow = flow_at(arms.before.picture, arms.after.picture, arms.bands);
  for (std::size_t i = 0; i < flow.size(); ++i) {
    ASSERT_TRUE(flow[i]) << i;
    EXPECT_LT((*flow[i] - arms.moved[i]).norm(), 0.3) << i;
  }
  EXPECT_THROW((void)flow_at(arms.before.picture, Image<std::uint8_t>(3, 3), arms.bands),
               std::invalid_argument);
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
