// An etalon that stands alone before a screen is drawn the quick way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "flexura/math/so3.h"
#include "flexura/render/prepared_scene.h"
#include "flexura/render/quick_picture.h"
#include "flexura/render/renderer.h"
#include "tests/support/picture_difference.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

Scene etalon_scene(TestRandom& random) {
  Scene scene;
  Etalon& etalon = scene.etalon.emplace();
  etalon.X_WE = {so3_exp(random.vector<3>(-1, 1)), random.vector<3>(-0.2, 0.2)};
  etalon.radius = random.uniform(0.03, 0.15), etalon.height = random.uniform(0.2, 0.8);
  etalon.line_width = random.integer(0, 4) == 0 ? 0 : random.uniform(0.002, 0.03);
  etalon.albedo = {0.1, 0.15, 0.2}, etalon.line_albedo = {0.9, 0.1, 0.1};
  return scene;
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

// Beside the etalon, before it, behind it or through it.
void add_screen(TestRandom& random, Scene& scene, const View& view) {
  const Eigen::Vector3d ahead = view.X_WC.rotation.col(2);
  Screen& screen = scene.screens.emplace_back();
  screen.X_WS.rotation = rotation_from_z((-ahead + 0.6 * random.vector<3>(-1, 1)).normalized());
  screen.X_WS.position =
      scene.etalon->X_WE.position + random.uniform(-0.5, 1.5) * ahead + random.vector<3>(-0.6, 0.6);
  screen.size = {random.uniform(0.3, 3), random.uniform(0.3, 3)};
}

TEST(QuickEtalon, AgreesWithTheExactWay) {
  double worst = 0;
  int drawn = 0, pixels = 0, left = 0;
  for_random_cases(300, [&](TestRandom& random) {
    Scene scene = etalon_scene(random);
    const View view = view_of(random, scene, 64, 48);
    for (int i = random.integer(0, 2); i > 0; --i) add_screen(random, scene, view);
    const PixelKind kind = random.integer(0, 1) == 1 ? PixelKind::color : PixelKind::gray;
    Renderer renderer;
    LightImage exact, quick;
    renderer.render(scene, view, kind, exact, true);
    renderer.render(scene, view, kind, quick);
    for (std::size_t i = 0; i < exact.light.values().size(); ++i)
      worst = std::max(worst, std::abs(exact.light.values()[i] - quick.light.values()[i]) + 0.0);
    for (std::size_t i = 0; i < exact.depth.values().size(); ++i) {
      const double a = exact.depth.values()[i] + 0.0, b = quick.depth.values()[i] + 0.0;
      if (a != b) {
        EXPECT_NEAR(b, a, 2e-6 * a);
      }
    }
    QuickPicture picture;
    renderer.prepare(scene, view);
    if (!picture.draw(renderer.prepared().stage, renderer.prepared().rays, view.lens.intrinsics(), kind,
                      quick))
      return;
    ++drawn, pixels += 64 * 48, left += static_cast<int>(picture.left_out().size());
  });
  std::printf("etalon: light differs by %.5f at worst, %.1f %% of %d pictures left out\n", worst,
              100.0 * left / pixels, drawn);
  EXPECT_LT(worst, 0.02);
  EXPECT_GT(drawn, 0);
}

// Bright ones, flat ones, some seen from so near, or by so long a lens, that they are hundreds of pixels
// wide.
TEST(QuickEtalon, AgreesWithTheExactWayWhateverItsSize) {
  double worst = 0;
  for_random_cases(300, [&](TestRandom& random) {
    Scene scene = etalon_scene(random);
    scene.etalon->albedo = Color::Constant(0.9), scene.background = Color::Zero();
    scene.etalon->height = std::pow(10, random.uniform(-2.5, 0));
    View view = view_of(random, scene, 64, 48);
    Intrinsics lens = view.lens.intrinsics();
    const double longer = std::pow(10, random.uniform(0, 2.5));
    lens.fx *= longer, lens.fy *= longer, lens.distortion = {};
    view.lens = Lens(lens);
    Renderer renderer;
    LightImage exact, quick;
    renderer.render(scene, view, PixelKind::gray, exact, true);
    renderer.render(scene, view, PixelKind::gray, quick);
    for (std::size_t i = 0; i < exact.light.values().size(); ++i)
      worst = std::max(worst, std::abs(exact.light.values()[i] - quick.light.values()[i]) + 0.0);
    for (std::size_t i = 0; i < exact.depth.values().size(); ++i)
      EXPECT_EQ(std::isinf(exact.depth.values()[i]), std::isinf(quick.depth.values()[i]));
  });
  std::printf("etalons of all sizes: light differs by %.5f at worst\n", worst);
  EXPECT_LT(worst, 0.05);
}

// The images of such ends are ellipses of 0.5 to 10 px by 10 to 100, of which a pixel may see both sides.
TEST(QuickEtalon, AgreesWithTheExactWayWhereAnEndIsSeenFromItsEdge) {
  constexpr int width = 96, height = 72;
  double worst = 0;
  for_random_cases(1000, [&](TestRandom& random) {
    Scene scene = etalon_scene(random);
    Etalon& etalon = *scene.etalon;
    etalon.albedo = Color::Constant(random.uniform(0, 1));
    const Eigen::Vector3d axis = etalon.X_WE.rotation.col(1);
    const Eigen::Vector3d end = etalon.X_WE.position + (random.integer(0, 1) - 0.5) * etalon.height * axis;
    const double far = random.uniform(1.5, 4), f = width * random.uniform(0.6, 8);  // m, px
    const double thickness = std::pow(10, random.uniform(-0.3, 1));                 // px
    const double sine =
        std::min(0.5, thickness * far / (2 * etalon.radius * f)) * (random.integer(0, 1) - 0.5);
    const Eigen::Vector3d aside =
        so3_exp(random.uniform(0, 2 * std::numbers::pi) * axis) * axis.unitOrthogonal();
    const Eigen::Vector3d eye = end + far * (std::sqrt(1 - 4 * sine * sine) * aside + 2 * sine * axis);
    const View view = pinhole_view(look_at(eye, end + 0.05 * random.vector<3>(-1, 1)), width, height, f);
    worst = std::max(worst, compare_ways(scene, view).worst);
  });
  std::printf("ends from the edge: light differs by %.5f at worst\n", worst);
  EXPECT_LT(worst, 0.04);
}

// Light and depth by which the quick way differs from the exact one.
struct EtalonDifference {
  double light = 0, depth = 0;  // Of the depth, a share.
  bool is_drawn_alike = true;   // Nothing but numbers, and seen where it is seen.
};
EtalonDifference difference(const Scene& scene, const View& view, PixelKind kind) {
  Renderer renderer;
  LightImage exact, quick;
  renderer.render(scene, view, kind, exact, true);
  renderer.render(scene, view, kind, quick);
  EtalonDifference all;
  for (std::size_t i = 0; i < exact.light.values().size(); ++i) {
    const double off = std::abs(exact.light.values()[i] - quick.light.values()[i]);
    all.is_drawn_alike &= std::isfinite(off);
    all.light = std::max(all.light, off);
  }
  for (std::size_t i = 0; i < exact.depth.values().size(); ++i) {
    const double a = exact.depth.values()[i], b = quick.depth.values()[i];
    all.is_drawn_alike &= std::isinf(a) == std::isinf(b);
    if (std::isfinite(a) && std::isfinite(b)) all.depth = std::max(all.depth, std::abs(a - b) / a);
  }
  return all;
}

// Upright or lying, its lines towards the camera and its axis through the middles of pixels: distances do not
// change in the image there.
TEST(QuickEtalon, AgreesWithTheExactWayWhereTheCameraIsAlignedWithIt) {
  double worst = 0;
  for_random_cases(300, [&](TestRandom& random) {
    Scene scene = etalon_scene(random);
    Etalon& etalon = *scene.etalon;
    constexpr double far = 2;  // m
    const double f = random.uniform(2, 12) * far / etalon.radius;
    etalon.line_width = std::min(1.4 * etalon.radius, random.uniform(1.6, 8) * far / f);
    Eigen::Matrix3d R_WE = Eigen::Matrix3d::Identity();
    if (random.integer(0, 1) == 1) R_WE << 0, 1, 0, -1, 0, 0, 0, 0, 1;
    etalon.X_WE = {R_WE, Eigen::Vector3d::Zero()};
    View view;
    view.X_WC.rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();
    view.X_WC.position = {0, 0, far};
    view.width = 65, view.height = 49;
    view.lens = Lens({.fx = f, .fy = f, .cx = 32, .cy = 24});
    const EtalonDifference all =
        difference(scene, view, random.integer(0, 1) == 1 ? PixelKind::color : PixelKind::gray);
    EXPECT_TRUE(all.is_drawn_alike);
    worst = std::max(worst, all.light);
  });
  std::printf("etalons that the camera is aligned with: light differs by %.5f at worst\n", worst);
  EXPECT_LT(worst, 0.05);
}

// Flat ones, so near that their skin is seen of less than half of the rim, in pictures of the place where
// contour and rim meet.
TEST(QuickEtalon, AgreesWithTheExactWayWhereRimsAreNear) {
  double worst = 0, farthest = 0;
  for_random_cases(1000, [&](TestRandom& random) {
    Scene scene = etalon_scene(random);
    Etalon& etalon = *scene.etalon;
    etalon.albedo = Color::Constant(random.uniform(0, 1));
    etalon.height = random.uniform(0.05, 0.35) * etalon.radius, etalon.line_width = 0;
    const Eigen::Vector3d middle = etalon.X_WE.position, axis = etalon.X_WE.rotation.col(1);
    const double bound = std::hypot(0.5 * etalon.height, etalon.radius);
    const double far = bound * random.uniform(4.1, 8);
    const double f = std::exp(random.uniform(std::log(60), std::log(600))) * far / etalon.radius;
    const Eigen::Vector3d aside =
        so3_exp(random.uniform(0, 2 * std::numbers::pi) * axis) * axis.unitOrthogonal();
    const double slant = random.uniform(-0.7, 0.7);
    const Eigen::Vector3d eye = middle + far * (std::sqrt(1 - slant * slant) * aside + slant * axis);
    const Eigen::Vector3d aim = middle + 0.5 * etalon.height * random.uniform(-1.2, 1.2) * axis +
                                etalon.radius * random.uniform(-1.1, 1.1) * aside.cross(axis);
    const EtalonDifference all = difference(
        scene, pinhole_view(look_at(eye, aim, random.vector<3>(-1, 1)), 64, 48, f), PixelKind::gray);
    EXPECT_TRUE(all.is_drawn_alike);
    worst = std::max(worst, all.light), farthest = std::max(farthest, all.depth);
  });
  std::printf("rims that are near: light differs by %.5f at worst, depth by %.2g of it\n", worst, farthest);
  EXPECT_LT(worst, 0.04);
  EXPECT_LT(farthest, 1e-5);
}

TEST(QuickEtalon, IsTheSameOnEveryPath) {
  for_random_cases(40, [&](TestRandom& random) {
    Scene scene = etalon_scene(random);
    scene.etalon->height = std::pow(10, random.uniform(-2.5, 0));
    const View view = view_of(random, scene, 61, 48);
    for (int i = random.integer(0, 2); i > 0; --i) add_screen(random, scene, view);
    const PixelKind kind = random.integer(0, 1) == 1 ? PixelKind::color : PixelKind::gray;
    LightImage expected;
    Renderer(SimdPath::baseline).render(scene, view, kind, expected);
    for (const SimdPath path : available_simd_paths()) {
      LightImage picture;
      Renderer(path).render(scene, view, kind, picture);
      EXPECT_EQ(picture.light, expected.light) << name_of(path);
      EXPECT_EQ(picture.depth, expected.depth) << name_of(path);
    }
  });
}

// What a calibration looks at: upright, 1.5 m away, by 640 x 480 px, zoomed in.
TEST(QuickEtalon, LeavesHardlyAnythingToTheExactWay) {
  constexpr double f = 2000, far = 1.53;  // px, m
  Scene scene = plain_scene();
  scene.etalon.emplace().X_WE.position = {0, 0.3, 0};
  const View view = pinhole_view(look_at({0.3, 0.3, 1.5}, {0, 0.3, 0}), 640, 480, f);
  Renderer renderer;
  const auto left_out = [&] {
    renderer.prepare(scene, view);
    LightImage picture{Image<float>(640, 480), Image<float>(640, 480)};
    QuickPicture quick;
    EXPECT_TRUE(quick.draw(renderer.prepared().stage, renderer.prepared().rays, view.lens.intrinsics(),
                           PixelKind::gray, picture));
    return quick.left_out().size();
  };
  const double area = 2 * f * scene.etalon->radius / far * f * scene.etalon->height / far;  // px
  const auto alone = static_cast<double>(left_out());
  std::printf("of an etalon of %.0f pixels %.0f are left out\n", area, alone);
  EXPECT_LT(alone, 0.01 * area);
  // Beside something else it is left.
  scene.obstacles.push_back({SphereConfig{.center = {2, 0, -1}, .radius = 0.05}, {0.4, 0.5, 0.4}});
  EXPECT_GT(static_cast<double>(left_out()), 0.9 * area);
}

}  // namespace
}  // namespace flexura
