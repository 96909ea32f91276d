#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "flexura/math/so3.h"
#include "flexura/render/prepared_scene.h"
#include "flexura/render/quick_picture.h"
#include "flexura/render/renderer.h"
#include "tests/support/picture_difference.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

// Two small screens before, behind and through a ringed arm, their edges in its skin, its contours and its
// ends.
TEST(QuickScreens, AgreesWithTheExactWayWhereEdgesOfScreensAreSeen) {
  int bad_depths = 0;
  double worst = 0;
  for_random_cases(300, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0);
    const Backbone backbone = bent.backbone();
    const View view = pinhole_view(random_view_of(random, backbone).X_WC, 48, 36, 60 * random.uniform(1, 6));
    Scene scene;
    scene.arm.tube = tube_of(bent.arm, backbone);
    for (int i = random.integer(0, 6); i > 0; --i) {
      const double s = random.uniform(0, 1);
      scene.arm.markers.push_back({s, s + random.uniform(0.01, 0.1), {0.9, 0.9, 0.9}});
    }
    const Eigen::Vector3d ahead = view.X_WC.rotation.col(2);
    for (int i = 0; i < 2; ++i) {
      Screen& screen = scene.screens.emplace_back();
      const Eigen::Vector3d out = (-ahead + 0.6 * random.vector<3>(-1, 1)).normalized();
      screen.X_WS.rotation = rotation_from_z(out);
      const Eigen::Vector3d place = backbone.pose(random.uniform(0, 1) * backbone.length()).position;
      screen.X_WS.position = place + random.uniform(-0.4, 0.4) * ahead + random.vector<3>(-0.1, 0.1);
      screen.size = {random.uniform(0.1, 0.6), random.uniform(0.1, 0.6)};
    }
    const Difference off = compare_ways(scene, view);
    EXPECT_LT(off.worst, 0.04);
    worst = std::max(worst, off.worst), bad_depths += off.bad_depths;
  });
  EXPECT_EQ(bad_depths, 0);
  std::printf("edges of screens: light differs by %.5f at worst\n", worst);
}

// Where the edge of one screen is before or behind another, or where two cross, nothing is left out; only
// where both have edges, and at corners.
TEST(QuickScreens, DrawsScreensThatOverlap) {
  const View view = pinhole_view(look_at({0, 0, 2}, {0, 0, 0}), 160, 120, 200);
  for_random_cases(20, [&](TestRandom& random) {
    Scene scene;
    for (const double z : {0.0, -0.5}) {
      Screen& screen = scene.screens.emplace_back();
      screen.X_WS.position = random.vector<3>(-0.05, 0.05) + Eigen::Vector3d(0, 0, z);
      screen.size = z < 0 ? std::array<double, 2>{1.4, 0.4} : std::array<double, 2>{0.4, 0.8};
      screen.X_WS.rotation = so3_exp(random.vector<3>(-0.1, 0.1));
      if (z < 0 && random.integer(0, 1) == 1)
        screen.X_WS.position.z() = 0, screen.X_WS.rotation = so3_exp({0, 1.2, 0.3});
      screen.brightness = Color::Constant(random.uniform(0.2, 1));
      screen.gradient = {random.uniform(-0.3, 0.3), 0.1}, screen.falloff = 0.2;
    }
    if (random.integer(0, 1) == 1) std::swap(scene.screens[0], scene.screens[1]);
    Renderer renderer;
    LightImage exact, quick;
    renderer.render(scene, view, PixelKind::gray, exact, true);
    renderer.render(scene, view, PixelKind::gray, quick);
    EXPECT_LT(compare(exact, quick).worst, 0.002);
    EXPECT_EQ(compare(exact, quick).bad_depths, 0);
    QuickPicture way;
    LightImage picture{Image<float>(160, 120), Image<float>(160, 120)};
    ASSERT_TRUE(way.draw(renderer.prepared().stage, renderer.prepared().rays, view.lens.intrinsics(),
                         PixelKind::gray, picture));
    EXPECT_LT(way.left_out().size(), 150U);  // Corners, and where edges cross.
  });
}

// The two ways' pictures of screens, whose light may differ by `most`.
void expect_agreement_on(const Scene& scene, const View& view, double most) {
  const Difference off = compare_ways(scene, view);
  EXPECT_LT(off.worst, most);
  EXPECT_EQ(off.bad_depths, 0);
}

Screen gray_screen(const Eigen::Vector3d& position, const std::array<double, 2>& size, double brightness) {
  Screen screen;
  screen.X_WS.position = position, screen.size = size, screen.brightness = Color::Constant(brightness);
  screen.gradient = {0, 0}, screen.falloff = 0;
  return screen;
}

// What a third screen's edge leaves of a pixel in which two cross is no one's mean.
TEST(QuickScreens, DrawsAThirdScreenBeforeTwoThatCross) {
  const View view = pinhole_view(look_at({0, 0, 2}, {0, 0, 0}), 160, 120, 200);
  for_random_cases(40, [&](TestRandom& random) {
    Scene scene;
    scene.screens = {gray_screen({0, 0, 0}, {0.8, 0.8}, 0), gray_screen({0, 0, 0}, {0.8, 0.8}, 1),
                     gray_screen({0, 0, 0.8}, {0.3, 0.1}, random.uniform(0, 1))};
    scene.screens[1].X_WS.rotation = so3_exp({random.uniform(-0.1, 0.1), random.uniform(0.3, 1.2), 0});
    // One of its edges along the crossing, or across.
    scene.screens[2].X_WS.position.x() = random.uniform(-0.01, 0.01) + (random.integer(0, 1) == 1 ? 0.15 : 0);
    expect_agreement_on(scene, view, 0.002);
  });
}

TEST(QuickScreens, DrawsScreensOfOnePlane) {
  for (const double distance : {1.2, 1.5, 2.0, 2.5, 3.0, 3.1, 3.7, 4.0})
    for (const double turn : {0.0, 1e-17, 1e-12, 1e-9}) {
      const View view = pinhole_view(look_at({0, 0, distance}, {0, 0, 0}), 80, 60, 60 * distance);
      Scene scene;
      scene.screens = {gray_screen({0, 0, 0}, {0.8, 0.4}, 0.3), gray_screen({0.1, 0.05, 0}, {0.2, 0.8}, 1)};
      scene.screens[1].X_WS.rotation = so3_exp({0, turn, 0});
      SCOPED_TRACE(testing::Message() << distance << " m, " << turn);
      expect_agreement_on(scene, view, 0.002);
    }
}

// The line is where doubles have it.
TEST(QuickScreens, DrawsScreensThatCrossAtASmallAngle) {
  for_random_cases(40, [&](TestRandom& random) {
    const View view = pinhole_view(look_at(Eigen::Vector3d(0, 0, 2) + random.vector<3>(-0.3, 0.3), {0, 0, 0}),
                                   160, 120, 800);
    Scene scene;
    scene.screens = {gray_screen({0, 0, 0}, {0.8, 0.8}, 0), gray_screen({0, 0, 0}, {0.8, 0.8}, 1)};
    scene.screens[1].X_WS.rotation = so3_exp({0, random.uniform(0.001, 0.05), random.uniform(-0.5, 0.5)});
    expect_agreement_on(scene, view, 0.002);
  });
}

// Light that changes by a tenth of full scale from pixel to pixel is taken at each part's centroid.
TEST(QuickScreens, TakesLightWhereThePartsOfAPixelAre) {
  const View view = pinhole_view(look_at({0, 0, 2}, {0, 0, 0}), 80, 60, 50);
  for_random_cases(40, [&](TestRandom& random) {
    Scene scene;
    scene.screens = {gray_screen({0, 0, -0.3}, {0.9, 0.9}, 0.5), gray_screen({0, 0, 0}, {0.9, 0.5}, 0.5)};
    for (Screen& screen : scene.screens) {
      screen.X_WS.rotation = so3_exp(random.vector<3>(-0.5, 0.5));
      screen.gradient = {random.uniform(-1, 1), random.uniform(-1, 1)};
    }
    expect_agreement_on(scene, view, 0.002);
  });
}

// Whose plane the camera is in: it shows nothing of itself, and is compared with nothing.
TEST(QuickScreens, DrawsScreensBesideOneSeenFromItsEdge) {
  const View view = pinhole_view(look_at({0, 0, 2}, {0, 0, 0}), 80, 60, 100);
  for (const bool is_first : {false, true}) {
    Scene scene;
    scene.screens = {gray_screen({0, 0, 0}, {0.8, 0.8}, 1), gray_screen({0, 0, 0.5}, {0.8, 0.8}, 0.5)};
    scene.screens[is_first ? 0 : 1].X_WS.rotation.col(0) = Eigen::Vector3d::UnitZ();
    scene.screens[is_first ? 0 : 1].X_WS.rotation.col(2) = -Eigen::Vector3d::UnitX();
    expect_agreement_on(scene, view, 0.002);
  }
}

// A screen seen all but from its edge ends within a pixel of where its plane does.
TEST(QuickScreens, AgreesWithTheExactWayOnScreensSeenAslantThroughWideLenses) {
  double worst = 0;
  for_random_cases(400, [&](TestRandom& random) {
    Scene scene;
    Screen& screen = scene.screens.emplace_back();
    screen.X_WS = {so3_exp(random.vector<3>(-2, 2)), random.vector<3>(-0.5, 0.5)};
    screen.size = {random.uniform(0.5, 3), random.uniform(0.5, 3)};
    // From close to the screen's plane.
    const Eigen::Vector3d aside = screen.X_WS.rotation * random.vector<3>(-1, 1).normalized();
    const Eigen::Vector3d out = screen.X_WS.rotation.col(2);
    View view = pinhole_view(
        look_at(screen.X_WS.position + 2 * (aside - 0.9 * aside.dot(out) * out), screen.X_WS.position), 40,
        30, random.uniform(20, 60));
    Intrinsics lens = view.lens.intrinsics();
    lens.distortion = {random.uniform(-0.1, 0.4), 0, 0.001, 0, 0};
    view.lens = Lens(lens);
    worst = std::max(worst, compare_ways(scene, view).worst);
  });
  std::printf("screens seen aslant: light differs by %.5f at worst\n", worst);
  EXPECT_LT(worst, 0.002);
}

}  // namespace
}  // namespace flexura
