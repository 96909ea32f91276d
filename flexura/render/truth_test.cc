#include "flexura/render/truth.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "flexura/math/so3.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

// A straight arm of 1 m along +Y, radius 0.05, two sections, a marker on each.
struct StraightArm {
  Arm arm;
  Scene scene = plain_scene();

  StraightArm() {
    for (int i = 0; i < 2; ++i) arm.sections.push_back({.length = 0.5, .radius = {0.05, 0.05}});
    scene.arm.tube = tube_of(Backbone(arm, ArmState::straight(2)));
    scene.arm.markers = {{0.2, 0.3, {1, 0, 0}}, {0.6, 0.64, {0, 1, 0}}};
  }
};
constexpr double away = 2;
View side_view() { return pinhole_view(look_at({0, 0.5, away}, {0, 0.5, 0}), 161, 161, 140); }

TEST(Truth, LabelsAreNumbersAndBack) {
  for (const SurfaceLabel label :
       {SurfaceLabel{}, SurfaceLabel{SurfaceKind::section, 4095}, SurfaceLabel{SurfaceKind::obstacle, 7}})
    EXPECT_EQ(label_from_value(label_value(label)), label);
}

TEST(Truth, NamesWhatEachPixelShows) {
  const StraightArm straight;
  Renderer renderer;
  renderer.prepare(straight.scene, side_view());
  TruthMaps maps;
  truth_maps(renderer, maps);
  for (int v = 40; v <= 120; ++v) {
    // On the axis the surface is at the distance minus the radius; the ray's height there is y.
    const double depth = away - 0.05, y = 0.5 - (v - 80) / 140.0 * depth;
    if (y < 0 || y > 1 || v == 80) continue;  // At 80 the sections meet.
    EXPECT_NEAR(maps.depth.at(80, v), depth, 1e-6);
    EXPECT_NEAR(maps.s.at(80, v), y, 1e-6);
    SurfaceLabel expected{SurfaceKind::section, static_cast<std::uint16_t>(y < 0.5 ? 0 : 1)};
    for (std::uint16_t i = 0; i < 2; ++i) {
      const MarkerRing& marker = straight.scene.arm.markers[i];
      if (y >= marker.s_from && y < marker.s_to) expected = {SurfaceKind::marker, i};
    }
    EXPECT_EQ(label_from_value(maps.label.at(80, v)), expected) << v;
    const PixelTruth one = pixel_truth(renderer, 80, v);
    EXPECT_EQ(one.label, expected);
    EXPECT_EQ(static_cast<float>(one.depth), maps.depth.at(80, v));
    EXPECT_EQ(static_cast<float>(one.s), maps.s.at(80, v));
  }
  EXPECT_THROW((void)pixel_truth(renderer, 161, 0), std::out_of_range);
  EXPECT_EQ(label_from_value(maps.label.at(0, 0)).kind, SurfaceKind::background);
  EXPECT_EQ(maps.depth.at(0, 0), std::numeric_limits<float>::infinity());
  EXPECT_TRUE(std::isnan(maps.s.at(0, 0)));
}

TEST(Truth, CoverageOfAllKindsAddsUpToOne) {
  for_random_cases(3, [](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0.004);
    const Backbone backbone = bent.backbone();
    Scene scene = plain_scene();
    scene.arm.tube = tube_of(backbone);
    scene.arm.markers.push_back({0.4, 0.6, {1, 0, 0}});
    Renderer renderer;
    View view = random_view_of(random, backbone);
    renderer.prepare(scene, view);
    Image<float> sum(view.width, view.height);
    for (const SurfaceKind kind :
         {SurfaceKind::background, SurfaceKind::section, SurfaceKind::cap, SurfaceKind::marker}) {
      const Image<float> part = coverage(renderer, kind);
      for (std::size_t i = 0; i < sum.values().size(); ++i) sum.values()[i] += part.values()[i];
    }
    for (const float value : sum.values()) EXPECT_NEAR(value, 1, 1e-5);
  });
}

TEST(Truth, MarkerEdgesAreWhereTheirCirclesProject) {
  // Seen perpendicularly from the side, the edge at y is the half of the circle on the camera's side; on the
  // axis at depth D - r.
  const StraightArm straight;
  Renderer renderer;
  renderer.prepare(straight.scene, side_view());
  for (std::uint16_t i = 0; i < 2; ++i) {
    const Image<float> seen = coverage(renderer, SurfaceKind::marker, i);
    double column = 0;
    for (int v = 0; v < 161; ++v) column += seen.at(80, v);
    const MarkerRing& marker = straight.scene.arm.markers[i];
    // Mean over the pixel's width, half a pixel to either side.
    double expected = 0;
    for (int part = 0; part < 100; ++part) {
      const double a = (part - 49.5) / 100 / 140, square = 1 + a * a;
      const double depth = (away - std::sqrt(away * away - square * (away * away - 0.0025))) / square;
      expected += 0.01 * 140 * (marker.s_to - marker.s_from) / depth;
    }
    EXPECT_NEAR(column, expected, 2e-4);
  }
  const auto views = marker_views(renderer);
  ASSERT_EQ(views.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const MarkerRing& marker = straight.scene.arm.markers[i];
    const double middle = 0.5 * (marker.s_from + marker.s_to);
    EXPECT_NEAR(views[i].center.pixel->y(), 80 - 140 * (middle - 0.5) / away, 1e-9);
    EXPECT_TRUE(views[i].center.is_visible);
    EXPECT_NEAR(views[i].area, sum_of(coverage(renderer, SurfaceKind::marker, static_cast<std::uint16_t>(i))),
                1e-3);
    EXPECT_NEAR(views[i].centroid.x(), 80, 1e-3);
  }
}

TEST(Truth, TheEtalonsLinesAreAsWideAsTheyProject) {
  // A line in front, rotated by `turn`: its edges are lines on the cylinder, at the angles turn +- w/2r.
  for (const double turn : {0.0, 0.3, -0.7}) {
    Scene scene = plain_scene();
    Etalon etalon;
    etalon.radius = 0.2, etalon.height = 4, etalon.line_width = 0.03;
    etalon.X_WE.rotation = so3_exp({0, turn, 0});
    scene.etalon = etalon;
    const View view = pinhole_view(look_at({0, 0, 1.5}, {0, 0, 0}), 161, 21, 200);
    Renderer renderer;
    renderer.prepare(scene, view);
    const Image<float> seen = coverage(renderer, SurfaceKind::etalon_line, 0);
    const auto column_of = [&](double angle) {
      return 200 * 0.2 * std::sin(angle) / (1.5 - 0.2 * std::cos(angle));
    };
    const double half = 0.5 * 0.03 / 0.2;
    EXPECT_NEAR(sum_of(seen), 21 * (column_of(turn + half) - column_of(turn - half)), 2e-2) << turn;
  }
}

TEST(Truth, TheAxisIsHiddenWhereTheArmHidesItself) {
  // A full ring in the XZ plane seen from the side: the far half lies behind the near half.
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.push_back({.length = 2, .radius = {0.03, 0.03}});
  arm.X_WB.rotation = Eigen::Matrix3d::Identity();
  ArmState state = ArmState::straight(1);
  state.bends[0] = {1.9 * std::numbers::pi, 0};
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(Backbone(arm, state));
  Renderer renderer;
  // The ring's middle is at x = R; the camera on -x looks along +x.
  renderer.prepare(scene, pinhole_view(look_at({-3, 0, 0}, {0, 0, 0}), 200, 100, 150));
  const std::array<double, 2> s = {0.02, 1.05};
  const auto axis = projected_axis(renderer, s);
  EXPECT_TRUE(axis[0].is_visible);
  EXPECT_FALSE(axis[1].is_visible);
}

}  // namespace
}  // namespace flexura
