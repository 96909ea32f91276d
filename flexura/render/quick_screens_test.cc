#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "flexura/math/so3.h"
#include "tests/support/picture_difference.h"
#include "tests/support/render_scenes.h"

namespace flexura {
namespace {

// Two small screens in front of, behind and through a ringed arm, with edges in its skin, contours and ends.
TEST(QuickScreens, AgreesWithTheExactWayWhereEdgesOfScreensAreSeen) {
  const Difference all = compare_paths_of("edges of screens", 150, 0.04, [](TestRandom& random) {
    const BentArm bent = random_bent_arm(random, 0);
    const Backbone backbone = bent.backbone();
    SceneView scene_view;
    scene_view.view = pinhole_view(random_view_of(random, backbone).X_WC, 48, 36, 60 * random.uniform(1, 6));
    Scene& scene = scene_view.scene;
    scene.arm.tube = tube_of(backbone);
    for (int i = random.integer(0, 6); i > 0; --i) {
      const double s = random.uniform(0, 1);
      scene.arm.markers.push_back({s, s + random.uniform(0.01, 0.1), {0.9, 0.9, 0.9}});
    }
    const Eigen::Vector3d ahead = scene_view.view.X_WC.rotation.col(2);
    for (int i = 0; i < 2; ++i) {
      Screen& screen = scene.screens.emplace_back();
      screen.X_WS.rotation = rotation_from_z((-ahead + 0.6 * random.vector<3>(-1, 1)).normalized());
      const Eigen::Vector3d place = backbone.pose(random.uniform(0, 1) * backbone.length()).position;
      screen.X_WS.position = place + random.uniform(-0.4, 0.4) * ahead + random.vector<3>(-0.1, 0.1);
      screen.size = {random.uniform(0.1, 0.6), random.uniform(0.1, 0.6)};
    }
    return scene_view;
  });
  EXPECT_EQ(all.bad_depths, 0);
}

// Compares the paths' pictures of screens alone; their light, also at edges, must agree to 1/500.
template <typename Add>
void expect_agreement_on(const char* name, int count, const View& view, Add&& add) {
  const auto draw = [&](TestRandom& random) {
    SceneView scene_view{{}, view};
    add(random, scene_view);
    return scene_view;
  };
  EXPECT_EQ(compare_paths_of(name, count, 0.002, draw).bad_depths, 0);
}
View front_view(int width, int height, double focal_length, double distance = 2) {
  return pinhole_view(look_at({0, 0, distance}, {0, 0, 0}), width, height, focal_length);
}
Screen gray_screen(const Eigen::Vector3d& position, const std::array<double, 2>& size, double brightness) {
  Screen screen;
  screen.X_WS.position = position, screen.size = size, screen.brightness = Color::Constant(brightness);
  screen.gradient = {0, 0}, screen.falloff = 0;
  return screen;
}

// One screen's edge in front of or behind another, or two screens that cross.
TEST(QuickScreens, DrawsScreensThatOverlap) {
  expect_agreement_on(
      "overlapping screens", 20, front_view(160, 120, 200), [](auto& random, SceneView& scene_view) {
        for (const double z : {0.0, -0.5}) {
          Screen& screen = scene_view.scene.screens.emplace_back();
          screen.X_WS.position = random.template vector<3>(-0.05, 0.05) + Eigen::Vector3d(0, 0, z);
          screen.size = z < 0 ? std::array<double, 2>{1.4, 0.4} : std::array<double, 2>{0.4, 0.8};
          screen.X_WS.rotation = so3_exp(random.template vector<3>(-0.1, 0.1));
          if (z < 0 && random.integer(0, 1) == 1)
            screen.X_WS.position.z() = 0, screen.X_WS.rotation = so3_exp({0, 1.2, 0.3});
          screen.brightness = Color::Constant(random.uniform(0.2, 1));
          screen.gradient = {random.uniform(-0.3, 0.3), 0.1}, screen.falloff = 0.2;
        }
        if (random.integer(0, 1) == 1) std::swap(scene_view.scene.screens[0], scene_view.scene.screens[1]);
      });
}

// If a third screen's edge cuts a pixel in which two others cross, the mean light of these two is not that of
// their visible part. One of its edges is along or across the crossing.
TEST(QuickScreens, DrawsAThirdScreenBeforeTwoThatCross) {
  expect_agreement_on(
      "a third screen", 40, front_view(160, 120, 200), [](auto& random, SceneView& scene_view) {
        scene_view.scene.screens = {gray_screen({0, 0, 0}, {0.8, 0.8}, 0),
                                    gray_screen({0, 0, 0}, {0.8, 0.8}, 1),
                                    gray_screen({0, 0, 0.8}, {0.3, 0.1}, random.uniform(0, 1))};
        scene_view.scene.screens[1].X_WS.rotation =
            so3_exp({random.uniform(-0.1, 0.1), random.uniform(0.3, 1.2), 0});
        scene_view.scene.screens[2].X_WS.position.x() =
            random.uniform(-0.01, 0.01) + (random.integer(0, 1) == 1 ? 0.15 : 0);
      });
}

TEST(QuickScreens, DrawsScreensOfOnePlane) {
  for (const double distance : {1.2, 2.0, 3.1, 4.0}) {
    int turned = 0;
    expect_agreement_on("one plane", 4, front_view(80, 60, 60 * distance, distance),
                        [&](auto&, SceneView& scene_view) {
                          constexpr double turns[] = {0, 1e-17, 1e-12, 1e-9};
                          scene_view.scene.screens = {gray_screen({0, 0, 0}, {0.8, 0.4}, 0.3),
                                                      gray_screen({0.1, 0.05, 0}, {0.2, 0.8}, 1)};
                          scene_view.scene.screens[1].X_WS.rotation = so3_exp({0, turns[turned++], 0});
                        });
  }
}

// The line is as accurate as double precision.
TEST(QuickScreens, DrawsScreensThatCrossAtASmallAngle) {
  expect_agreement_on("small angles", 40, {}, [](auto& random, SceneView& scene_view) {
    const Eigen::Vector3d from = Eigen::Vector3d(0, 0, 2) + random.template vector<3>(-0.3, 0.3);
    scene_view.view = pinhole_view(look_at(from, {0, 0, 0}), 160, 120, 800);
    scene_view.scene.screens = {gray_screen({0, 0, 0}, {0.8, 0.8}, 0), gray_screen({0, 0, 0}, {0.8, 0.8}, 1)};
    scene_view.scene.screens[1].X_WS.rotation =
        so3_exp({0, random.uniform(0.001, 0.05), random.uniform(-0.5, 0.5)});
  });
}

// Light that changes by a tenth of full scale per pixel is taken at each part's centroid.
TEST(QuickScreens, TakesLightWhereThePartsOfAPixelAre) {
  expect_agreement_on("steep light", 40, front_view(80, 60, 50), [](auto& random, SceneView& scene_view) {
    scene_view.scene.screens = {gray_screen({0, 0, -0.3}, {0.9, 0.9}, 0.5),
                                gray_screen({0, 0, 0}, {0.9, 0.5}, 0.5)};
    for (Screen& screen : scene_view.scene.screens) {
      screen.X_WS.rotation = so3_exp(random.template vector<3>(-0.5, 0.5));
      screen.gradient = {random.uniform(-1, 1), random.uniform(-1, 1)};
    }
  });
}

// The camera is in the plane of one screen, which is therefore invisible.
TEST(QuickScreens, DrawsScreensBesideOneSeenFromItsEdge) {
  for (const std::size_t which : {0U, 1U})
    expect_agreement_on("from the edge", 1, front_view(80, 60, 100), [which](auto&, SceneView& scene_view) {
      scene_view.scene.screens = {gray_screen({0, 0, 0}, {0.8, 0.8}, 1),
                                  gray_screen({0, 0, 0.5}, {0.8, 0.8}, 0.5)};
      Eigen::Matrix3d& R_WS = scene_view.scene.screens[which].X_WS.rotation;
      R_WS.col(0) = Eigen::Vector3d::UnitZ(), R_WS.col(2) = -Eigen::Vector3d::UnitX();
    });
}

// A screen seen almost edge-on ends within a pixel of its plane's horizon.
TEST(QuickScreens, AgreesWithTheExactWayOnScreensSeenAslantThroughWideLenses) {
  const auto draw = [](TestRandom& random) {
    SceneView scene_view;
    Screen& screen = scene_view.scene.screens.emplace_back();
    screen.X_WS = {so3_exp(random.vector<3>(-2, 2)), random.vector<3>(-0.5, 0.5)};
    screen.size = {random.uniform(0.5, 3), random.uniform(0.5, 3)};
    // From close to the screen's plane.
    const Eigen::Vector3d aside = screen.X_WS.rotation * random.vector<3>(-1, 1).normalized();
    const Eigen::Vector3d out = screen.X_WS.rotation.col(2), at = screen.X_WS.position;
    scene_view.view = pinhole_view(look_at(at + 2 * (aside - 0.9 * aside.dot(out) * out), at), 40, 30,
                                   random.uniform(20, 60));
    Intrinsics lens = scene_view.view.lens.intrinsics();
    lens.distortion = {random.uniform(-0.1, 0.4), 0, 0.001, 0, 0};
    scene_view.view.lens = Lens(lens);
    return scene_view;
  };
  compare_paths_of("screens seen aslant", 300, 0.002, draw);
}

}  // namespace
}  // namespace flexura
