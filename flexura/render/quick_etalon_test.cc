// The fast path on an etalon that stands alone in front of a screen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "flexura/math/so3.h"
#include "tests/support/picture_difference.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

SceneView etalon_scene(TestRandom& random) {
  SceneView scene_view;
  Etalon& etalon = scene_view.scene.etalon.emplace();
  etalon.X_WE = {so3_exp(random.vector<3>(-1, 1)), random.vector<3>(-0.2, 0.2)};
  etalon.radius = random.uniform(0.03, 0.15), etalon.height = random.uniform(0.2, 0.8);
  etalon.line_width = random.integer(0, 4) == 0 ? 0 : random.uniform(0.002, 0.03);
  etalon.albedo = {0.1, 0.15, 0.2}, etalon.line_albedo = {0.9, 0.1, 0.1};
  if (random.integer(0, 1) == 1) scene_view.pixels = PixelKind::color;
  return scene_view;
}

// From 1.5 to 4 m, the etalon anywhere in the picture, half of the lenses with distortion.
View view_of(TestRandom& random, const Scene& scene, int width, int height) {
  const Eigen::Vector3d middle = scene.etalon->X_WE.position;
  const Eigen::Vector3d eye = middle + random.uniform(1.5, 4) * random.vector<3>(-1, 1).normalized();
  View view = pinhole_view(look_at(eye, middle + random.vector<3>(-0.2, 0.2)), width, height,
                           width * random.uniform(0.6, 5));
  Intrinsics lens = view.lens.intrinsics();
  lens.fy *= random.uniform(0.8, 1.25);
  if (random.integer(0, 1) == 1) lens.distortion[0] = random.uniform(-0.2, 0.2);
  view.lens = Lens(lens);
  return view;
}

// Screens beside the etalon, in front of it, behind it or through it.
void add_screens(TestRandom& random, SceneView& scene_view) {
  const Eigen::Vector3d ahead = scene_view.view.X_WC.rotation.col(2);
  for (int i = random.integer(0, 2); i > 0; --i) {
    Screen& screen = scene_view.scene.screens.emplace_back();
    screen.X_WS.rotation = rotation_from_z((-ahead + 0.6 * random.vector<3>(-1, 1)).normalized());
    screen.X_WS.position = scene_view.scene.etalon->X_WE.position + random.uniform(-0.5, 1.5) * ahead +
                           random.vector<3>(-0.6, 0.6);
    screen.size = {random.uniform(0.3, 3), random.uniform(0.3, 3)};
  }
}

// A random direction perpendicular to the axis.
Eigen::Vector3d any_side(TestRandom& random, const Eigen::Vector3d& axis) {
  return so3_exp(random.uniform(0, 2 * std::numbers::pi) * axis) * axis.unitOrthogonal();
}

TEST(QuickEtalon, AgreesWithTheExactWay) {
  const Difference all = compare_paths_of("etalons", 150, 0.02, [](TestRandom& random) {
    SceneView scene_view = etalon_scene(random);
    scene_view.view = view_of(random, scene_view.scene, 64, 48);
    add_screens(random, scene_view);
    return scene_view;
  });
  EXPECT_EQ(all.bad_depths, 0);
}

// Includes bright and flat ones, and some seen from so near, or by so long a lens, that they are hundreds of
// pixels wide.
TEST(QuickEtalon, AgreesWithTheExactWayWhateverItsSize) {
  const auto draw = [](TestRandom& random) {
    SceneView scene_view = etalon_scene(random);
    scene_view.scene.etalon->albedo = Color::Constant(0.9), scene_view.scene.background = Color::Zero();
    scene_view.scene.etalon->height = std::pow(10, random.uniform(-2.5, 0));
    scene_view.view = view_of(random, scene_view.scene, 64, 48);
    Intrinsics lens = scene_view.view.lens.intrinsics();
    const double longer = std::pow(10, random.uniform(0, 2.5));
    lens.fx *= longer, lens.fy *= longer, lens.distortion = {};
    scene_view.view.lens = Lens(lens);
    return scene_view;
  };
  compare_paths_of("etalons of all sizes", 150, 0.05, draw);
}

// The images of such ends are ellipses of 0.5 to 10 px by 10 to 100 px; a pixel may see both sides.
TEST(QuickEtalon, AgreesWithTheExactWayWhereAnEndIsSeenFromItsEdge) {
  constexpr int width = 96, height = 72;
  compare_paths_of("ends from the edge", 300, 0.04, [](TestRandom& random) {
    SceneView scene_view = etalon_scene(random);
    Etalon& etalon = *scene_view.scene.etalon;
    etalon.albedo = Color::Constant(random.uniform(0, 1));
    const Eigen::Vector3d axis = etalon.X_WE.rotation.col(1);
    const Eigen::Vector3d end = etalon.X_WE.position + (random.integer(0, 1) - 0.5) * etalon.height * axis;
    const double far = random.uniform(1.5, 4), f = width * random.uniform(0.6, 8);  // m, px
    const double thickness = std::pow(10, random.uniform(-0.3, 1));                 // px
    const double sine =
        std::min(0.5, thickness * far / (2 * etalon.radius * f)) * (random.integer(0, 1) - 0.5);
    const Eigen::Vector3d eye =
        end + far * (std::sqrt(1 - 4 * sine * sine) * any_side(random, axis) + 2 * sine * axis);
    scene_view.view = pinhole_view(look_at(eye, end + 0.05 * random.vector<3>(-1, 1)), width, height, f);
    return scene_view;
  });
}

// Upright or lying, with its lines towards the camera and its axis through the middles of pixels: image
// derivatives of distances vanish there.
TEST(QuickEtalon, AgreesWithTheExactWayWhereTheCameraIsAlignedWithIt) {
  compare_paths_of("aligned etalons", 100, 0.05, [](TestRandom& random) {
    SceneView scene_view = etalon_scene(random);
    Etalon& etalon = *scene_view.scene.etalon;
    constexpr double far = 2;  // m
    const double f = random.uniform(2, 12) * far / etalon.radius;
    etalon.line_width = std::min(1.4 * etalon.radius, random.uniform(1.6, 8) * far / f);
    etalon.X_WE = {};
    if (random.integer(0, 1) == 1) etalon.X_WE.rotation << 0, 1, 0, -1, 0, 0, 0, 0, 1;
    const Eigen::Matrix3d R_WC = Eigen::Vector3d(1, -1, -1).asDiagonal();
    scene_view.view = pinhole_view({R_WC, {0, 0, far}}, 65, 49, f);
    return scene_view;
  });
}

// Flat ones, so near that skin is visible along less than half of the rim. The pictures show where contour
// and rim meet.
TEST(QuickEtalon, AgreesWithTheExactWayWhereRimsAreNear) {
  compare_paths_of("rims that are near", 300, 0.04, [](TestRandom& random) {
    SceneView scene_view = etalon_scene(random);
    Etalon& etalon = *scene_view.scene.etalon;
    etalon.albedo = Color::Constant(random.uniform(0, 1));
    etalon.height = random.uniform(0.05, 0.35) * etalon.radius, etalon.line_width = 0;
    const Eigen::Vector3d middle = etalon.X_WE.position, axis = etalon.X_WE.rotation.col(1);
    const double far = std::hypot(0.5 * etalon.height, etalon.radius) * random.uniform(4.1, 8);
    const double f = std::exp(random.uniform(std::log(60), std::log(600))) * far / etalon.radius;
    const Eigen::Vector3d aside = any_side(random, axis);
    const double slant = random.uniform(-0.7, 0.7);
    const Eigen::Vector3d eye = middle + far * (std::sqrt(1 - slant * slant) * aside + slant * axis);
    const Eigen::Vector3d aim = middle + 0.5 * etalon.height * random.uniform(-1.2, 1.2) * axis +
                                etalon.radius * random.uniform(-1.1, 1.1) * aside.cross(axis);
    scene_view.view = pinhole_view(look_at(eye, aim, random.vector<3>(-1, 1)), 64, 48, f);
    return scene_view;
  });
}

TEST(QuickEtalon, IsTheSameOnEveryPath) {
  for_random_cases(30, [&](TestRandom& random) {
    SceneView scene_view = etalon_scene(random);
    scene_view.scene.etalon->height = std::pow(10, random.uniform(-2.5, 0));
    scene_view.view = view_of(random, scene_view.scene, 61, 48);
    add_screens(random, scene_view);
    expect_same_on_every_path(scene_view);
  });
}

// As in a calibration: upright, 1.5 m away, 640 x 480 px, zoomed in.
TEST(QuickEtalon, LeavesHardlyAnythingToTheExactWay) {
  constexpr double f = 2000, far = 1.53;  // px, m
  Scene scene = plain_scene();
  scene.etalon.emplace().X_WE.position = {0, 0.3, 0};
  const View view = pinhole_view(look_at({0.3, 0.3, 1.5}, {0, 0.3, 0}), 640, 480, f);
  const double area = 2 * f * scene.etalon->radius / far * f * scene.etalon->height / far;  // px
  const auto alone = static_cast<double>(left_out_of(scene, view));
  std::printf("of an etalon of %.0f pixels %.0f are left out\n", area, alone);
  EXPECT_LT(alone, 0.01 * area);
  // Next to another body the fast path does not draw it.
  scene.obstacles.push_back({SphereConfig{.center = {2, 0, -1}, .radius = 0.05}, {0.4, 0.5, 0.4}});
  EXPECT_GT(static_cast<double>(left_out_of(scene, view)), 0.9 * area);
}

}  // namespace
}  // namespace flexura
