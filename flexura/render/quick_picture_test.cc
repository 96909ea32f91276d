#include "flexura/render/quick_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "flexura/math/so3.h"
#include "flexura/render/prepared_scene.h"
#include "flexura/render/renderer.h"
#include "tests/support/picture_difference.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

// An arm with rings in front of one or two screens, sometimes with an obstacle, a round tip, disks or a
// taper.
Scene busy_scene(TestRandom& random, const Backbone& backbone, const View& view) {
  Scene scene;
  scene.arm.tube = tube_of(backbone);
  if (random.integer(0, 3) == 0) scene.arm.tip = TipKind::round;
  for (int i = random.integer(0, 12); i > 0; --i) {
    const double s = random.uniform(-0.02, 1);
    scene.arm.markers.push_back({s, s + random.uniform(0.001, 0.03)});
  }
  if (random.integer(0, 3) == 0) scene.arm.disks.push_back({.s = 0.4});
  const Eigen::Vector3d ahead = view.X_WC.rotation.col(2);
  for (int i = random.integer(0, 2); i > 0; --i) {
    Screen& screen = scene.screens.emplace_back();
    const Eigen::Vector3d out = (-ahead + 0.6 * random.vector<3>(-1, 1)).normalized();
    screen.X_WS.rotation = rotation_from_z(out);
    screen.X_WS.position = view.X_WC.position + 3 * ahead + random.vector<3>(-1, 1);
    if (random.integer(0, 1) == 1) screen.gradient = {random.uniform(-0.3, 0.3), 0.1}, screen.falloff = 0.2;
  }
  if (random.integer(0, 3) == 0) {
    const Eigen::Vector3d at =
        backbone.pose(random.uniform(0, 0.9) * backbone.length()).position + random.vector<3>(-0.1, 0.1);
    scene.obstacles.push_back(
        {SphereConfig{.center = {at.x(), at.y(), at.z()}, .radius = 0.05}, {0.4, 0.5, 0.4}});
  }
  // A floor under the arm, partly crossed by it; its horizon runs through the picture.
  if (scene.screens.size() == 1) {
    const Eigen::Vector3d foot = backbone.pose(0.2 * backbone.length()).position;
    const Eigen::Vector3d up = -view.X_WC.rotation.col(1) - 0.1 * ahead + 0.1 * view.X_WC.rotation.col(0);
    scene.obstacles.push_back(
        {PlaneConfig{.point = {foot.x(), foot.y(), foot.z()}, .normal = {up.x(), up.y(), up.z()}},
         {0.3, 0.3, 0.35}});
  }
  return scene;
}

// The arm's radius is 2 to 30 px.
View some_view(TestRandom& random, const Backbone& backbone) {
  const View view = random_view_of(random, backbone);
  return pinhole_view(view.X_WC, 160, 120, 200 * random.uniform(0.5, 5));
}

TEST(QuickPicture, AgreesWithTheExactWay) {
  const Difference all = compare_paths_of("busy scenes", 25, 0.015, [](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, random.integer(0, 1) == 0 ? 0.003 : 0);
    const View view = some_view(random, bent.backbone());
    const Scene scene = busy_scene(random, bent.backbone(), view);
    return SceneView{scene, view, random.integer(0, 1) == 1 ? PixelKind::color : PixelKind::gray};
  });
  // The few cases of a sanitized build do not determine the mean.
  if (one_case_of == 1) {
    EXPECT_LT(all.count, 1e-4 * all.many);
  }
  EXPECT_EQ(all.bad_depths, 0);
}

// Thick and thin arms, tapered or not, bent gently and sharply, of one section or four. Near, or far through
// a long lens; with non-square pixels, with distortion, with bright rings on dark skin.
TEST(QuickPicture, AgreesWithTheExactWayInAllKindsOfScenes) {
  // For light that differs by 0.8 between the sides of an edge.
  const Difference all = compare_paths_of("all kinds of scenes", 150, 0.04, [](TestRandom& random) {
    BentArm bent;
    bent.arm.kind = ArmKind::spatial;
    const int count = random.integer(1, 4);
    bent.state = ArmState::straight(static_cast<std::size_t>(count));
    double radius = random.uniform(0.01, 0.05);
    const double tapering = random.integer(0, 1) == 0 ? random.uniform(-0.1, 0.05) : 0;
    for (Eigen::Vector2d& bend : bent.state.bends) {
      const double length = random.uniform(0.05, 0.4), end = std::max(0.004, radius + tapering * length);
      bent.arm.sections.push_back({.length = length, .radius = {radius, end}});
      radius = end;
      if (random.integer(0, 2) != 0) bend = random.vector<2>(-3, 3);
    }
    const Backbone backbone = bent.backbone();
    View view = random_view_of(random, backbone);
    const double distance = random.integer(0, 1) == 0 ? 1 : std::pow(10, random.uniform(0, 3));
    const Eigen::Vector3d ahead = view.X_WC.rotation.col(2);
    if (distance > 1) view.X_WC.position = backbone.pose(0.5 * backbone.length()).position - distance * ahead;
    view = pinhole_view(view.X_WC, 48, 36, 200 * distance * random.uniform(0.5, 5));
    Intrinsics intrinsics = view.lens.intrinsics();
    intrinsics.fy *= random.uniform(0.5, 2);
    if (random.integer(0, 1) == 1) intrinsics.distortion[0] = random.uniform(-0.2, 0.2);
    if (random.integer(0, 3) == 0) intrinsics.distortion = {random.uniform(-0.1, 0.1), 0.01, 0, 0};
    if (random.integer(0, 5) == 0)
      intrinsics.distortion = {-0.1, 0, 0, 0, 0, random.uniform(-0.1, 0.2), 0, 0};
    view.lens = Lens(intrinsics);
    Scene scene = busy_scene(random, backbone, view);
    for (MarkerRing& ring : scene.arm.markers) ring.albedo = {0.9, 0.9, 0.9};
    return SceneView{scene, view};
  });
  EXPECT_EQ(all.bad_depths, 0);
}

TEST(QuickPicture, DrawsTaperedArmsToo) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  arm.sections.push_back({.length = 0.5, .radius = {0.04, 0.03}});
  arm.sections.push_back({.length = 0.5, .radius = {0.03, 0.028}});
  const ArmState state = {{{0.5, 0.2}, {-0.7, 0.3}}, {1, 1}};
  const View view = pinhole_view(look_at({0.3, 0.5, 2}, {0, 0.5, 0}), 160, 120, 200);
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(Backbone(arm, state));
  scene.arm.markers = {{0.2, 0.25}, {0.7, 0.75}};
  // It covers some 700 pixels.
  EXPECT_LT(left_out_of(scene, view), 30);
  // Cones are left to the reference path.
  arm.sections[0].radius = {0.09, 0.03};
  scene.arm.tube = tube_of(Backbone(arm, state));
  EXPECT_GT(left_out_of(scene, view), 300);
}

// An elastic arm in motion is a chain of many short arcs whose curvature changes little from one to the next.
TEST(QuickPicture, DrawsChainsOfSimilarArcs) {
  constexpr int count = 60;
  Arm arm;
  arm.kind = ArmKind::spatial;
  ArmState state = ArmState::straight(count);
  for (int i = 0; i < count; ++i) {
    arm.sections.push_back({.length = 1.0 / count, .radius = {0.02, 0.02}});
    const double s = (i + 0.5) / count;
    state.bends[static_cast<std::size_t>(i)] = Eigen::Vector2d(2 * std::cos(2 * s), std::sin(3 * s)) / count;
  }
  const View view = pinhole_view(look_at({0.3, 0.5, 2}, {0, 0.5, 0}), 320, 240, 400);
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(Backbone(arm, state));
  // Some 2000 pixels show the arm, and 500 its contour.
  EXPECT_LT(left_out_of(scene, view), 200);
  const Difference all = compare_paths(scene, view);
  EXPECT_LT(all.worst, 0.003);
  EXPECT_EQ(all.bad_depths, 0);
}

// A renderer keeps pixels that show only screens. A screen that covers a part of another one's edge leaves
// some to the reference path.
TEST(QuickPicture, DoesNotDependOnEarlierPictures) {
  for_random_cases(4, [](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0);
    const View view = some_view(random, bent.backbone());
    Scene scene = busy_scene(random, bent.backbone(), view);
    const Eigen::Vector3d ahead = view.X_WC.rotation.col(2);
    for (const double distance : {3.0, 3.5}) {
      Screen& screen = scene.screens.emplace_back();
      screen.X_WS = {rotation_from_z(-ahead), view.X_WC.position + distance * ahead};
      screen.size = {distance > 3 ? 1.0 : 0.3, 0.4};
    }
    Renderer kept;
    for (int i = 0; i < 6; ++i) {
      scene.arm.tube = tube_of(random_bent_arm(random, 0).backbone());
      if (i == 4) scene.screens.back().brightness *= 0.9;
      View seen = view;
      if (i % 2 == 1) seen.X_WC.position.x() += 0.01;
      LightImage one, other;
      kept.render(scene, seen, PixelKind::gray, one);
      Renderer().render(scene, seen, PixelKind::gray, other);
      EXPECT_TRUE(std::ranges::equal(one.light.values(), other.light.values()));
      EXPECT_TRUE(std::ranges::equal(one.depth.values(), other.depth.values()));
    }
  });
}

// The fast path still draws two sections with a disk at their joint.
TEST(QuickPicture, DrawsSectionsBesideDisks) {
  Arm arm;
  arm.kind = ArmKind::spatial;
  for (int i = 0; i < 2; ++i) arm.sections.push_back({.length = 0.5, .radius = {0.03, 0.03}});
  const Backbone backbone(arm, {{{0.2, 0}, {-0.3, 0.1}}, {1, 1}});
  const View view = pinhole_view(look_at({0, 0.5, 2}, {0, 0.5, 0}), 160, 120, 200);
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(backbone);
  const std::size_t without = left_out_of(scene, view);
  scene.arm.disks.push_back({.s = 0.5, .radius = 0.05, .thickness = 0.01});
  const std::size_t with = left_out_of(scene, view);
  EXPECT_LT(with - without, 250);  // 6 px by 10, and the surroundings.
}

TEST(QuickPicture, IsTheSameOnEveryPath) {
  for_random_cases(8, [&](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, random.integer(0, 1) == 0 ? 0.004 : 0);
    View view = some_view(random, bent.backbone());
    view.width -= random.integer(0, 30);
    const Scene scene = busy_scene(random, bent.backbone(), view);
    const PixelKind pixels = random.integer(0, 1) == 1 ? PixelKind::color : PixelKind::gray;
    expect_same_on_every_path({scene, view, pixels});
  });
}

TEST(QuickPicture, KnowsWhatItDoesNotKnow) {
  const BentArm bent = [] {
    TestRandom random(3);
    return random_bent_arm(random, 0);
  }();
  TestRandom random(4);
  const View view = random_view_of(random, bent.backbone());
  Scene scene = plain_scene();
  scene.arm.tube = tube_of(bent.backbone());
  const auto is_drawn = [](const Scene& one, const View& seen) {
    return left_out_of(one, seen) <
           static_cast<std::size_t>(seen.width) * static_cast<std::size_t>(seen.height);
  };
  EXPECT_TRUE(is_drawn(scene, view));
  View near = view;
  near.X_WC.position = bent.backbone().pose(0.3).position;
  EXPECT_FALSE(is_drawn(scene, near));
  View long_lens = view;
  Intrinsics tall = view.lens.intrinsics();
  tall.fy = 1e200;
  long_lens.lens = Lens(tall);
  EXPECT_FALSE(is_drawn(scene, long_lens));
  Scene shadowed = scene;
  shadowed.light.shadow = 0.5;
  EXPECT_FALSE(is_drawn(shadowed, view));
}

// Upright in front of a floor: of an empty scene everything below the horizon is left out, and three rows
// above.
TEST(QuickPicture, LeavesOutWhatLiesBelowAFloorsHorizon) {
  for (const double height : {1.0, -1.0}) {
    Scene scene;
    scene.obstacles.push_back({PlaneConfig{}});
    Eigen::Matrix3d R_WC;
    R_WC << 1, 0, 0, 0, -1, 0, 0, 0, -1;
    const View view = pinhole_view({R_WC, {0, height, 2}}, 64, 49, 200);
    Renderer renderer;
    renderer.prepare(scene, view);
    LightImage picture{Image<float>(64, 49, 1), Image<float>(64, 49, 1)};
    QuickPicture quick;
    ASSERT_TRUE(quick.draw(renderer.prepared().stage, renderer.prepared().rays, view.lens.intrinsics(),
                           PixelKind::gray, picture));
    const auto& left = quick.left_out();
    if (height < 0) {
      EXPECT_TRUE(left.empty()) << "from below it is not seen";
      continue;
    }
    ASSERT_FALSE(left.empty());
    const double horizon = view.lens.intrinsics().cy;
    EXPECT_NEAR(left.front().v, horizon - 3, 1);
    EXPECT_EQ(left.size(), static_cast<std::size_t>((49 - left.front().v) * 64));
  }
}

}  // namespace
}  // namespace flexura
