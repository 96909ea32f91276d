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
  SeenArmConfig options;
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

// Two instants of an arm with bands: before, and bent a little more.
struct Moments {
  SeenArm before, after;
  std::vector<Eigen::Vector2d> bands;  // Where their middles are seen before ...
  std::vector<Eigen::Vector2d> moved;  // ... and by how much they move.
};
Moments banded_moments() {
  const auto seen_at = [](double bend) {
    SeenArm seen;
    BentArm bent;
    bent.arm.kind = ArmKind::spatial;
    bent.arm.sections.resize(2, {.length = 0.4, .radius = {0.02, 0.02}});
    bent.state = ArmState::straight(2);
    bent.state.bends = {{0.2, bend}, {-0.3, -bend}};
    seen.scene.background = Color::Constant(0.85);
    seen.scene.arm.tube = tube_of(bent.arm, bent.backbone());
    for (double s = 0.08; s < 0.78; s += 0.1)
      seen.scene.arm.markers.push_back({s - 0.01, s + 0.01, Color::Constant(0.6)});
    seen.view = pinhole_view(look_at({0, 0.4, 1.6}, {0, 0.4, 0}), 640, 480, 800);
    seen.picture = photograph(seen.scene, seen.view, {.noise = 1}, bend > 0.5 ? 2 : 1);
    seen.truth = true_axis(seen.scene, seen.view, 2001);
    return seen;
  };
  Moments moments{seen_at(0.5), seen_at(0.54), {}, {}};
  Renderer before, after;
  before.prepare(moments.before.scene, moments.before.view);
  after.prepare(moments.after.scene, moments.after.view);
  const auto from = marker_views(before), to = marker_views(after);
  for (std::size_t i = 0; i < from.size(); ++i) {
    moments.bands.push_back(*from[i].center.pixel);
    moments.moved.emplace_back(*to[i].center.pixel - *from[i].center.pixel);
  }
  return moments;
}

TEST(CurveFlow, OfADrawnArmIsThatOfItsBackbone) {
  const Moments moments = banded_moments();
  ArmFinder finder;
  const auto before = finder.find(moments.before.picture).axis;
  const auto after = finder.find(moments.after.picture).axis;
  const CurveFlow flow = curve_flow(before, after);
  const auto& from = moments.before.truth;
  const auto& to = moments.after.truth;
  const auto angle = [](const std::vector<AxisPoint>& curve, std::size_t i) {
    const Eigen::Vector2d way = *curve[i + 10].pixel - *curve[i - 10].pixel;
    return std::atan2(way.y(), way.x());
  };
  double squares = 0, turn_squares = 0, count = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!std::isfinite(flow.normal[i]) || !std::isfinite(flow.turn[i])) continue;
    std::size_t nearest = 10;
    for (std::size_t k = 10; k + 10 < from.size(); ++k)
      if ((*from[k].pixel - before[i].pixel).norm() < (*from[nearest].pixel - before[i].pixel).norm())
        nearest = k;
    // From the same place along the normal to the later backbone: its distance, the motion being small.
    const double expected = distance_to(to, *from[nearest].pixel);
    // distance_to() counts from the curve to the place, from u towards v.
    squares += std::pow(flow.normal[i] + expected, 2);
    const double turn = std::remainder(angle(to, nearest) - angle(from, nearest), 6.283185307179586);
    turn_squares += std::pow(flow.turn[i] - turn, 2), ++count;
  }
  ASSERT_GT(count, 100);
  EXPECT_LT(std::sqrt(squares / count), 0.05);
  EXPECT_LT(std::sqrt(turn_squares / count), 0.01);
}

TEST(CurveFlow, OfBandsIsTheirMotion) {
  const Moments moments = banded_moments();
  double largest = 0;
  for (const Eigen::Vector2d& way : moments.moved) largest = std::max(largest, way.norm());
  ASSERT_GT(largest, 2);
  for (const FlowMethod method : {FlowMethod::lucas_kanade, FlowMethod::dis}) {
    const auto flow = flow_at(moments.before.picture, moments.after.picture, moments.bands, method);
    for (std::size_t i = 0; i < flow.size(); ++i) {
      ASSERT_TRUE(flow[i]) << i;
      EXPECT_LT((*flow[i] - moments.moved[i]).norm(), method == FlowMethod::dis ? 0.6 : 0.3)
          << i << ", method " << static_cast<int>(method);
    }
  }
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
