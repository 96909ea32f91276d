#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "flexura/math/so3.h"
#include "flexura/render/renderer.h"
#include "tests/support/arms.h"
#include "tests/support/random_cases.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

LightImage picture_of(const Scene& scene, const View& view, PixelKind pixels = PixelKind::gray) {
  Renderer renderer;
  LightImage picture;
  renderer.render(scene, view, pixels, picture);
  return picture;
}

VisibleObstacle white(const ObstacleConfig& shape) { return {shape, {1, 1, 1}}; }

TEST(LightImage, OfASphereHasTheAreaOfItsEllipse) {
  for_random_cases(20, [](TestRandom& random) {
    const double radius = random.uniform(0.05, 0.4), depth = random.uniform(2, 4), focal_length = 150;
    const Eigen::Vector2d off = random.vector<2>(-0.5, 0.5);
    Scene scene = plain_scene();
    scene.obstacles.push_back(white(SphereConfig{.center = {off.x(), off.y(), depth}, .radius = radius}));
    const double found = sum_of(picture_of(scene, pinhole_view(Pose{}, 160, 120, focal_length)).light);
    // The cone around the center c with half angle b, sin b = r/|c|, is cut by z = 1. With the cosine e of
    // the angle between c and the axis, the half axes of the ellipse are sin b cos b/(e^2 - sin^2 b) and sin
    // b/sqrt(e^2 - sin^2 b).
    const double square = off.squaredNorm() + depth * depth;
    const double sine = radius / std::sqrt(square), cosine = std::sqrt(1 - sine * sine);
    const double room = depth * depth / square - sine * sine;
    const double area = std::numbers::pi * sine * sine * cosine / (room * std::sqrt(room));
    EXPECT_NEAR(found, area * focal_length * focal_length, 2e-4 * found + 0.02);
  });
}

TEST(LightImage, OfAStraightTubeHasTheAreaBetweenItsEdgesAndRims) {
  // Seen perpendicularly from the side at distance D, the edges are parallel at f r/sqrt(D^2 - r^2). The
  // visible halves of the rims cut off or add pieces of ellipses. Here the tube leaves the image above and
  // below, so only the edges count.
  const double radius = 0.03, distance = 1.7, focal_length = 300;
  Arm arm;
  arm.sections.push_back({.length = 10, .radius = {radius, radius}});
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(Backbone(arm, ArmState::straight(1)));
  scene.arm.albedo = {1, 1, 1};
  for (const double turned : {0.0, 0.1, 0.5}) {
    const Eigen::Vector3d up(std::sin(turned), std::cos(turned), 0);
    const View view = pinhole_view(look_at({0.01, 5, distance}, {0.01, 5, 0}, up), 90, 60, focal_length);
    // The tube's axis passes the camera at depth D, 0.01 m to the side.
    const double square = distance * distance + 0.01 * 0.01;
    const double middle = std::atan2(0.01, distance), half = std::asin(radius / std::sqrt(square));
    const double width = focal_length * (std::tan(half + middle) + std::tan(half - middle));
    EXPECT_NEAR(sum_of(picture_of(scene, view).light), width * 60 / std::cos(turned), 2e-3);
  }
}

TEST(LightImage, OfAScreenHasItsAreaAndItsBrightness) {
  Scene scene = plain_scene();
  Screen screen;
  screen.X_WS.position = {0.03, -0.02, 2};
  screen.X_WS.rotation = so3_exp({0, 0, 0.3});
  screen.size = {0.5, 0.3};
  screen.brightness = {0.7, 0.7, 0.7};
  scene.screens.push_back(screen);
  const LightImage picture = picture_of(scene, pinhole_view(Pose{}, 120, 90, 200));
  EXPECT_NEAR(sum_of(picture.light), 0.7 * 0.5 * 0.3 * 200 * 200 / 4, 1e-3);
  EXPECT_FLOAT_EQ(picture.depth.at(60, 45), 2);
  EXPECT_EQ(picture.depth.at(0, 0), std::numeric_limits<float>::infinity());
}

TEST(LightImage, OfABoxHasTheAreaOfItsOutline) {
  Scene scene = plain_scene();
  scene.obstacles.push_back(white(BoxConfig{.center = {0, 0, 2}, .half_sizes = {0.2, 0.3, 0.4}}));
  // Seen from the front: only the front face, at depth 1.6.
  EXPECT_NEAR(sum_of(picture_of(scene, pinhole_view(Pose{}, 120, 120, 100)).light),
              0.4 * 0.6 * 100 * 100 / (1.6 * 1.6), 1e-3);
}

TEST(LightImage, OfAFloorEndsAtTheHorizon) {
  Scene scene = plain_scene();
  scene.obstacles.push_back(white(PlaneConfig{.point = {0, 1, 0}, .normal = {0, -1, 0}}));
  const View view = pinhole_view(Pose{}, 40, 31, 100);
  EXPECT_NEAR(sum_of(picture_of(scene, view).light), 40 * 15.5, 1e-3);
}

TEST(LightImage, OfASymmetricSceneIsSymmetric) {
  Scene scene;
  Arm arm = paper_arm();
  arm.sections.resize(3);
  for (Section& section : arm.sections) section.radius = {0.3, 0.3};
  scene.arm.tube = tube_of(Backbone(arm, ArmState::straight(3)));
  scene.arm.markers.push_back({1, 1.5, {1, 0, 0}});
  scene.arm.disks.push_back({2.5, 0.5, 0.1});
  scene.light.direction = {0, 1, 1};
  Screen screen;
  screen.X_WS.position = {0, 3, -3};
  screen.size = {8, 6};
  scene.screens.push_back(screen);
  const View view = pinhole_view(look_at({0, 4, 9}, {0, 3, 0}), 101, 81, 90);
  const auto asymmetry = [&](bool is_exact) {
    Renderer renderer;
    LightImage picture;
    renderer.render(scene, view, PixelKind::color, picture, is_exact);
    double largest = 0;
    for (int v = 0; v < 81; ++v) {
      for (int u = 0; u < 50; ++u) {
        for (int channel = 0; channel < 3; ++channel)
          largest = std::max(largest, std::abs(static_cast<double>(picture.light.at(u, v, channel)) -
                                               picture.light.at(100 - u, v, channel)));
      }
    }
    return largest;
  };
  EXPECT_LT(asymmetry(true), 1e-4);
  // The fast path samples rims, and ring edges near contours, at 256 points that are not symmetric: accurate
  // to a hundredth of a pixel.
  EXPECT_LT(asymmetry(false), 1e-2);
}

TEST(LightImage, IsTheSameWhateverWasDrawnBefore) {
  Arm arm = paper_arm();
  Scene scene;
  scene.arm.tube = tube_of(Backbone(arm, paper_state()));
  const View view = pinhole_view(look_at({-4, 6, 24}, {-4, 6, 0}), 64, 48, 80);
  const LightImage fresh = picture_of(scene, view);
  Renderer renderer;
  LightImage picture;
  renderer.render(plain_scene(), pinhole_view(Pose{}, 30, 20, 50), PixelKind::color, picture);
  renderer.render(scene, view, PixelKind::gray, picture);
  EXPECT_EQ(picture.light, fresh.light);
  EXPECT_EQ(picture.depth, fresh.depth);
}

}  // namespace
}  // namespace flexura
